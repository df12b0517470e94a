// SPDX-License-Identifier: Apache-2.0
// The accelerometer and gyroscope of a node, an MPU-6886 configured as in
// firmware/imu_node/mpu6886.h. From the true rate and acceleration it computes the registers every
// millisecond.
#pragma once

#include "kinalign/motion/mahony.h"
#include "kinalign/simulate/random.h"
#include "kinalign/wire/node_sample.h"

#include <array>
#include <cstdint>

namespace kinalign {

inline constexpr double standard_gravity = 9.80665;  // m/s2, also in the simulated world
inline constexpr double chip_rate_hz = 1000.0;
inline constexpr double chip_step_s = 1.0 / chip_rate_hz;

/// The errors of the chip and their sources. Noise density and sensitivity of the gyroscope: data
/// sheet (DS-000193, first page). Zero offsets: typical for such chips at start
/// (docs/imu_noise.md). Bandwidths and ranges: as set by the firmware. These are estimates: the
/// random walks, the accelerometer's sensitivity and the misalignment of the axes (the MPU-6050's
/// data sheet states at most 2 %). The gyroscope's walk has the size stated for an ADIS16448 in the
/// calibration of the EuRoC data sets; the accelerometer's walk is a tenth of the one stated there.
struct InertialSensorModel {
  double gyroscope_noise = 6.981e-5;         // rad/s/sqrt(Hz): 4 mdeg/s
  double gyroscope_walk = 2e-5;              // rad/s/sqrt(s)
  double gyroscope_zero = 0.01745;           // rad/s, uniform up to this: 1 deg/s
  double gyroscope_scale = 0.01;             // uniform up to this
  double gyroscope_bandwidth_hz = 41.0;      // -3 dB
  double gyroscope_range = 34.90658504;      // rad/s: 2000 deg/s
  double accelerometer_noise = 9.80665e-4;   // m/s2/sqrt(Hz): 100 ug
  double accelerometer_walk = 3e-4;          // m/s2/sqrt(s)
  double accelerometer_zero = 0.39;          // m/s2, uniform up to this: 40 mg
  double accelerometer_scale = 0.01;         // uniform up to this
  double accelerometer_bandwidth_hz = 44.8;  // -3 dB
  double accelerometer_range = 156.9064;     // m/s2: 16 g
  double misalignment = 0.01;  // rad, of each axis towards each other axis, uniform up to this
};

/// Errors of one chip. Without noise, measured = scale * true + zero.
struct SensorErrors {
  Eigen::Matrix3d gyroscope_scale = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d accelerometer_scale = Eigen::Matrix3d::Identity();
  Vec3 gyroscope_zero = Vec3::Zero();      // rad/s, present value; it drifts
  Vec3 accelerometer_zero = Vec3::Zero();  // m/s2
};

/// A filter with two equal poles at the chip's rate (bilinear), together -3 dB at `bandwidth_hz`.
/// Its bandwidth for white noise is 1.22 times as large. A movement is delayed by 0.205 /
/// bandwidth: 5.0 ms at 41 Hz. For its filter of 42 Hz, the register map of the MPU-6050 states 4.8
/// ms.
class ChipLowPass {
 public:
  explicit ChipLowPass(double bandwidth_hz);
  /// Filters a value. Before the first value, the input is assumed to have been constant.
  const Vec3& push(const Vec3& value);

 private:
  double keep_, take_;
  std::array<Vec3, 2> before_{Vec3::Zero(), Vec3::Zero()}, out_{Vec3::Zero(), Vec3::Zero()};
  bool begun_ = false;
};

/// A reading as it is in the registers.
struct RawReading {
  std::array<std::int16_t, 3> acceleration{}, angular_velocity{};

  bool operator==(const RawReading&) const = default;
};

/// One chip. Its errors are drawn by the constructor; noise and walks depend on the number of the
/// step.
class SimulatedSensor {
 public:
  SimulatedSensor(const InertialSensorModel& model, std::uint64_t seed);

  /// Returns the registers after the next chip step. `truth` is in the sensor's own axes.
  RawReading step(const InertialReading& truth);
  /// Lets the zero offsets drift for this time without a reading. Before the next value, the input
  /// is assumed to have been constant.
  void wait(double seconds);

  const SensorErrors& errors() const { return errors_; }
  /// Converts a reading to SI units, with the same float operations as the firmware.
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
