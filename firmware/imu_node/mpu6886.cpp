// SPDX-License-Identifier: Apache-2.0
#include "firmware/imu_node/mpu6886.h"

namespace kinalign::mpu6886 {

namespace {

constexpr float acceleration_step = 16.0F * 9.80665F / 32768.0F;            // m/s2
constexpr float angular_velocity_step = 2000.0F / 32768.0F * 0.017453293F;  // rad/s

}  // namespace

NodeSample sample_of(std::span<const std::uint8_t, values_size> registers) {
  const auto at = [&](std::size_t i) {
    const int high = registers[i], low = registers[i + 1];
    return static_cast<float>(static_cast<std::int16_t>(high << 8 | low));
  };
  NodeSample sample;
  sample.has_acceleration = sample.has_angular_velocity = sample.gravity_included = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sample.acceleration[axis] = at(2 * axis) * acceleration_step;
    sample.angular_velocity[axis] = at(8 + 2 * axis) * angular_velocity_step;
  }
  return sample;
}

}  // namespace kinalign::mpu6886
