// SPDX-License-Identifier: Apache-2.0
// The reading of a perfect inertial sensor on a moving body, from its places at five instants. It
// uses central differences of fourth order. Their error is the sixth derivative times h^4 / 90 (for
// people at h = 1 ms: below 1e-5 m/s2) and the fifth derivative times h^4 / 30.
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

/// The sensor's place for a pose of the whole body.
SensorPlace place_of(const Mounting& mounting, const GlobalPose& pose);

/// Rate, rad/s, and specific force, m/s2, in sensor space, in the middle of five places that are
/// `step_s` apart. A sensor at rest reads gravity upwards.
InertialReading true_reading(const std::array<SensorPlace, 5>& places, double step_s);

}  // namespace kinalign
