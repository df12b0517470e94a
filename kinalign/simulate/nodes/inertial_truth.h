// SPDX-License-Identifier: Apache-2.0
// What a perfect inertial sensor on a moving body would read, from its places at five instants:
// central differences of fourth order, whose error is that of the sixth derivative times h^4 / 90
// (people at h = 1 ms: below 1e-5 m/s2) and of the fifth times h^4 / 30.
#pragma once

#include "kinalign/motion/mahony.h"
#include "kinalign/motion/pose.h"

#include <array>
#include <string>

namespace kinalign {

/// Of a sensor in the world, y up.
struct SensorPlace {
  Vec3 position = Vec3::Zero();  // m
  Quat world_from_sensor = Quat::Identity();
};

/// Where a sensor sits: on the bone that begins at a joint.
struct Mounting {
  std::string node_name;
  std::size_t joint = 0;
  Vec3 offset = Vec3::Zero();  // m, from the joint, in the joint's space
  Quat bone_from_sensor = Quat::Identity();
};

SensorPlace place_of(const Mounting& mounting, const GlobalPose& pose);

/// The rate and the specific force in the sensor's space in the middle of five places, `step_s`
/// apart. A sensor at rest reads gravity upwards.
InertialReading true_reading(const std::array<SensorPlace, 5>& places, double step_s);

}  // namespace kinalign
