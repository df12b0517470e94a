// SPDX-License-Identifier: Apache-2.0
// The accelerometer and gyroscope of a node, an MPU-6886 set up as firmware/imu_node/mpu6886.h
// does: what its registers hold every millisecond, of the true rate and force at its place.
#pragma once

#include "kinalign/motion/mahony.h"
#include "kinalign/simulate/random.h"
#include "kinalign/wire/node_sample.h"

#include <array>
#include <cstdint>

namespace kinalign {

inline constexpr double standard_gravity = 9.80665;  // m/s2, also of the simulated world
inline constexpr double chip_rate_hz = 1000.0;
inline constexpr double chip_step_s = 1.0 / chip_rate_hz;

/// White noise and sensitivity of the gyroscope are the data sheet's (DS-000193, first page); zero
/// offsets are what such chips are known to show at start (formats.md 3.2); bandwidths and ranges
/// are those that the firmware sets. Estimated: random walks (that of the gyroscope is of the size
/// that the EuRoC data sets' calibration states for an ADIS16448, that of the accelerometer a tenth
/// of it), the accelerometer's sensitivity, and how far axes are from square (the MPU-6050's data
/// sheet has 2 % at the most).
struct InertialSensorModel {
  double gyroscope_noise = 6.981e-5;         // rad/s/sqrt(Hz): 4 mdeg/s
  double gyroscope_walk = 2e-5;              // rad/s/sqrt(s)
  double gyroscope_zero = 0.01745;           // rad/s, drawn evenly up to: 1 deg/s
  double gyroscope_scale = 0.01;             // drawn evenly up to
  double gyroscope_bandwidth_hz = 41.0;      // -3 dB
  double gyroscope_range = 34.90658504;      // rad/s: 2000 deg/s
  double accelerometer_noise = 9.80665e-4;   // m/s2/sqrt(Hz): 100 ug
  double accelerometer_walk = 3e-4;          // m/s2/sqrt(s)
  double accelerometer_zero = 0.39;          // m/s2, drawn evenly up to: 40 mg
  double accelerometer_scale = 0.01;         // drawn evenly up to
  double accelerometer_bandwidth_hz = 44.8;  // -3 dB
  double accelerometer_range = 156.9064;     // m/s2: 16 g
  double misalignment = 0.01;  // rad, each axis towards each other, drawn evenly up to
};

/// What one chip does to the truth: measured = scale * true + zero, but for noise.
struct SensorErrors {
  Eigen::Matrix3d gyroscope_scale = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d accelerometer_scale = Eigen::Matrix3d::Identity();
  Vec3 gyroscope_zero = Vec3::Zero();      // rad/s, now: it walks
  Vec3 accelerometer_zero = Vec3::Zero();  // m/s2
};

/// Two equal poles, -3 dB together at `bandwidth_hz`, at the chip's rate (bilinear): of white noise
/// comes through what 1.22 times the bandwidth holds, and a movement is seen 0.205 / bandwidth
/// late, 5.0 ms at 41 Hz (the registers' map of the MPU-6050 says 4.8 of its filter of 42 Hz).
class ChipLowPass {
 public:
  explicit ChipLowPass(double bandwidth_hz);
  /// The first value is taken to have stood for ever.
  const Vec3& push(const Vec3& value);

 private:
  double keep_, take_;
  std::array<Vec3, 2> before_{Vec3::Zero(), Vec3::Zero()}, out_{Vec3::Zero(), Vec3::Zero()};
  bool begun_ = false;
};

/// As the registers have them.
struct RawReading {
  std::array<std::int16_t, 3> acceleration{}, angular_velocity{};

  bool operator==(const RawReading&) const = default;
};

class SimulatedSensor {
 public:
  SimulatedSensor(const InertialSensorModel& model, std::uint64_t seed);

  /// The registers one chip step on; `truth` in the sensor's own space.
  RawReading step(const InertialReading& truth);
  /// Its zeros walk for so long, without a reading; the next truth is taken to have stood for ever.
  void wait(double seconds);

  const SensorErrors& errors() const { return errors_; }
  /// A reading in SI units, as the firmware computes it, to the last bit of a float.
  NodeSample sample_of(const RawReading& reading) const;
  InertialReading reading_of(const RawReading& reading) const;

 private:
  void walk(double seconds);

  InertialSensorModel model_;
  RandomStream gyroscope_noise_, accelerometer_noise_, walks_;
  SensorErrors errors_;
  ChipLowPass gyroscope_, accelerometer_;
  std::uint64_t steps_ = 0, walked_ = 0;
};

}  // namespace kinalign
