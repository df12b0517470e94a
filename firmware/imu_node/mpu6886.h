// SPDX-License-Identifier: Apache-2.0
// The settings and registers of the MPU-6886 by InvenSense, without the bus, which esp32_board.cpp
// has. Source: data sheet DS-000193, revision 1.1; register numbers are its numbers.
#pragma once

#include "kinalign/wire/node_sample.h"

#include <array>
#include <span>

namespace kinalign::mpu6886 {

inline constexpr std::uint8_t bus_address = 0x68;                         // AD0 low
inline constexpr std::uint8_t identity_register = 0x75, identity = 0x19;  // register 117, WHO_AM_I

struct Setting {
  std::uint8_t address = 0, value = 0, then_wait_ms = 0;
};

// The low-pass filters delay a movement by about 5 ms at these settings; the node's clock does not
// correct that. The data sheet gives bandwidths and no delays; 4.8 and 4.9 ms are those of the
// MPU-6050's filters of 42 and 44 Hz (its register map, register 26). The registers hold the last
// of 1000 readings a second, so a sample is up to 1 ms older still.
inline constexpr std::array settings{
    Setting{0x6b, 0x80, 100},  // register 107, PWR_MGMT_1: reset
    Setting{0x6b, 0x01, 100},  // awake, clock from the gyroscope's PLL; the gyroscope starts
    Setting{0x1a, 0x03, 0},    // register 26, CONFIG: gyroscope filtered at 41 Hz, 1000 readings/s
    Setting{0x1b, 0x18, 0},    // register 27, GYRO_CONFIG: +-2000 deg/s, with that filter
    Setting{0x1c, 0x18, 0},    // register 28, ACCEL_CONFIG: +-16 g
    Setting{0x1d, 0x03, 0},    // register 29, ACCEL_CONFIG 2: filtered at 44.8 Hz, 1000 readings/s
    Setting{0x19, 0x00, 0},    // register 25, SMPLRT_DIV: no reading is left out
    Setting{0x69, 0x02, 0},    // register 105, ACCEL_INTEL_CTRL: no limit below full scale
};

// Registers 59 to 72: acceleration, temperature, angular velocity; x, y, z of each, high byte
// first.
inline constexpr std::uint8_t values_register = 0x3b;
inline constexpr std::size_t values_size = 14;
NodeSample sample_of(std::span<const std::uint8_t, values_size> registers);

}  // namespace kinalign::mpu6886
