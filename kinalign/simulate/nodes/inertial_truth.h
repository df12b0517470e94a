// SPDX-License-Identifier: Apache-2.0
// The reading of a perfect inertial sensor on a moving body, computed from its positions and
// rotations at five times. It uses central differences of fourth order. The error of the
// acceleration is the sixth derivative times h^4 / 90 (for people at h = 1 ms: below 1e-5 m/s2).
// The error of the rate is the fifth derivative times h^4 / 30.
#pragma once

#include "kinalign/motion/mahony.h"
#include "kinalign/motion/pose.h"

#include <array>
#include <string>

namespace kinalign {

/// Position and rotation of a sensor in the world, y up.
struct SensorPlace {
  Vec3 position = Vec3::Zero();  // m
  Quat world_from_sensor = Quat::Identity();
};

/// Position of a sensor on the bone that begins at a joint.
struct Mounting {
  std::string node_name;
  std::size_t joint = 0;
  Vec3 offset = Vec3::Zero();  // m, from the joint, in the joint's space
  Quat bone_from_sensor = Quat::Identity();
};

/// Returns the position and rotation of the sensor for a pose of the whole body.
SensorPlace place_of(const Mounting& mounting, const GlobalPose& pose);

/// Returns rate, rad/s, and specific force, m/s2, in the sensor's axes, in the middle of five
/// places with distance `step_s`. The specific force of a sensor at rest points up.
InertialReading true_reading(const std::array<SensorPlace, 5>& places, double step_s);

}  // namespace kinalign
