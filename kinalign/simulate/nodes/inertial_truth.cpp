// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/inertial_truth.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/simulate/nodes/inertial_sensor.h"

namespace kinalign {

SensorPlace place_of(const Mounting& mounting, const GlobalPose& pose) {
  const Quat& bone = pose.rotations[mounting.joint];
  return {pose.positions[mounting.joint] + bone * mounting.offset,
          bone * mounting.bone_from_sensor};
}

InertialReading true_reading(const std::array<SensorPlace, 5>& places, double step_s) {
  const Quat to_sensor = places[2].world_from_sensor.conjugate();
  // The derivative of the rotation vectors relative to the middle place is the angular rate.
  const auto turned = [&](std::size_t k) {
    return rotation_vector(to_sensor * places[k].world_from_sensor);
  };
  const auto at = [&](std::size_t k) -> const Vec3& { return places[k].position; };
  // Central differences of fourth order. The weights are -1, 16, -30, 16, -1 divided by 12 h^2, and
  // 1, -8, 0, 8, -1 divided by 12 h.
  const Vec3 acceleration =
      (16.0 * (at(1) + at(3)) - (at(0) + at(4)) - 30.0 * at(2)) / (12.0 * step_s * step_s);
  const Vec3 rate = (8.0 * (turned(3) - turned(1)) - (turned(4) - turned(0))) / (12.0 * step_s);
  return {rate, to_sensor * Vec3(acceleration + standard_gravity * Vec3::UnitY())};
}

}  // namespace kinalign
