// SPDX-License-Identifier: Apache-2.0
// Orientation from gyroscope and accelerometer: the explicit complementary filter with bias
// estimation of Mahony, Hamel and Pflimlin, «Nonlinear complementary filters on the special
// orthogonal group», IEEE Transactions on Automatic Control 53(5), 2008, section V, with gravity as
// the only measured direction. The filter is deliberately simple: accelerations of the body are
// mistaken for gravity. The heading is not measured. It drifts with the bias about the vertical,
// which can't be estimated unless the sensor is turned over.
#pragma once

#include "kinalign/motion/arrays.h"

#include <optional>

namespace kinalign {

struct MahonyOptions {
  // Near the truth a tilt error e and a bias error b obey e' = b - tilt_gain e, b' = -bias_gain e.
  // This is critically damped if bias_gain is a quarter of tilt_gain squared, with the time
  // constant 2 / tilt_gain, here 20 s. Mahony et al. used 1/s and 0.3/s2 (from memory, not
  // verified), which is too fast for swinging limbs. The errors by which these gains were
  // chosen are in docs/imu_noise.md.
  double tilt_gain = 0.1;              // kP, 1/s; times a step it must be below 2
  double bias_gain = 0.0025;           // kI, 1/s2
  double heading = 0.0;                // rad, about +y, at the first sample
  Vec3 gyroscope_bias = Vec3::Zero();  // rad/s, initial estimate
  double longest_step_s = 0.5;         // a step longer than this is a gap
  double least_acceleration = 1.0;     // m/s2; below it (free fall) the direction of up is unknown
};

/// One reading, in the sensor's own space.
struct InertialReading {
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  Vec3 acceleration = Vec3::Zero();      // m/s2, specific force: at rest 9.8 upwards
};

class MahonyFilter {
 public:
  explicit MahonyFilter(const MahonyOptions& options = {});

  /// Takes the reading at the end of a step of `dt_s` s since the previous one. The first reading
  /// with a valid acceleration sets the tilt. After a gap the tilt is set again from gravity;
  /// heading and bias are kept. If the acceleration is not finite or too small, only the rate is
  /// used. Returns false if the rate is not finite: the reading is ignored, and the next step also
  /// covers its time. Returns false, too, if dt_s is not above 0; then its time is not counted.
  bool update(double dt_s, const InertialReading& reading);

  /// world_from_sensor, world y up. Until the direction of up is known, only the heading is set.
  const Quat& orientation() const { return orientation_; }
  const Vec3& gyroscope_bias() const { return bias_; }  // rad/s
  bool has_tilt() const { return has_tilt_; }

 private:
  std::optional<Vec3> up_in_sensor(const Vec3& acceleration) const;
  void set_tilt(const Vec3& up, double heading);

  MahonyOptions options_;
  Quat orientation_;
  Vec3 bias_;
  double waiting_s_ = 0.0;  // s, time of ignored readings
  bool has_tilt_ = false;
};

/// The rotation with this heading (rad, about +y) that rotates `up_in_sensor` (unit) to +y on the
/// shortest way. A sensor that is upside down is rotated by half a turn about its x axis.
Quat tilted(const Vec3& up_in_sensor, double heading);

/// The heading of a rotation: the rotation about +y that remains without the tilt; rad, -pi to pi.
double heading_of(const Quat& world_from_sensor);

}  // namespace kinalign
