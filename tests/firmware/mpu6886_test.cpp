// SPDX-License-Identifier: Apache-2.0
#include "firmware/imu_node/mpu6886.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE(
    "registers of the MPU-6886 in SI units: 16 g and 2000 deg/s full scale, high byte first") {
  const std::array<std::uint8_t, mpu6886::values_size> registers{
      0x08, 0x00, 0x80, 0x00, 0xff, 0xff,   // 2048, -32768, -1
      0x12, 0x34,                           // the temperature
      0x40, 0x00, 0xc0, 0x00, 0x00, 0x01};  // 16384, -16384, 1
  const NodeSample sample = mpu6886::sample_of(registers);
  CHECK(sample.has_acceleration);
  CHECK(sample.gravity_included);
  CHECK(sample.has_angular_velocity);
  CHECK(!sample.has_orientation);
  CHECK(sample.acceleration[0] == doctest::Approx(9.80665));
  CHECK(sample.acceleration[1] == doctest::Approx(-16 * 9.80665));
  CHECK(sample.acceleration[2] == doctest::Approx(-16 * 9.80665 / 32768));
  CHECK(sample.angular_velocity[0] == doctest::Approx(1000 * 3.14159265 / 180));
  CHECK(sample.angular_velocity[1] == doctest::Approx(-1000 * 3.14159265 / 180));
  CHECK(sample.angular_velocity[2] == doctest::Approx(2000.0 / 32768 * 3.14159265 / 180));
}

TEST_CASE("the sensor is reset first, and its filters stand at 41 and 44.8 Hz") {
  CHECK(mpu6886::settings.front().address == 0x6b);
  CHECK(mpu6886::settings.front().value == 0x80);
  for (const auto& setting : mpu6886::settings) {
    if (setting.address == 0x1a || setting.address == 0x1d) CHECK(setting.value == 3);
  }
}
