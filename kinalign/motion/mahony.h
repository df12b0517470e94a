// SPDX-License-Identifier: Apache-2.0
// Orientation from gyroscope and accelerometer: the explicit complementary filter with bias
// estimation of Mahony, Hamel and Pflimlin, «Nonlinear complementary filters on the special
// orthogonal group», IEEE Transactions on Automatic Control 53(5), 2008, section V, with gravity as
// the one measured direction. Plain on purpose: what an acceleration of the body adds to gravity
// is taken for gravity. Nothing measures the heading: it drifts with the bias about the vertical,
// which is not learnt unless the sensor is turned over.
#pragma once

#include "kinalign/motion/arrays.h"

#include <optional>

namespace kinalign {

struct MahonyOptions {
  // Near the truth a tilt error e and a bias error b obey e' = b - tilt_gain e, b' = -bias_gain e:
  // critically damped where bias_gain is a quarter of tilt_gain squared, then with the time
  // constant 2 / tilt_gain, here 20 s. The paper's experiments had 1/s and 0.3/s2 (recalled, not
  // looked up), which a limb that swings misleads: docs/imu_noise.md has the errors by
  // which these were chosen.
  double tilt_gain = 0.1;              // kP, 1/s; times a step it must stay below 2
  double bias_gain = 0.0025;           // kI, 1/s2
  double heading = 0.0;                // rad, about +y: of the first sample
  Vec3 gyroscope_bias = Vec3::Zero();  // rad/s, what is known of it at the start
  double longest_step_s = 0.5;         // a step longer than this is a gap
  double least_acceleration = 1.0;     // m/s2: below it, in free fall, nothing is up
};

/// One reading, in the sensor's own space.
struct InertialReading {
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  Vec3 acceleration = Vec3::Zero();      // m/s2, specific force: at rest 9.8 upwards
};

class MahonyFilter {
 public:
  explicit MahonyFilter(const MahonyOptions& options = {});

  /// The reading at the end of a step of `dt_s` since the one before. The first one that says where
  /// up is sets the tilt, without a turn. Behind a gap, what happened in it is unknown: the tilt
  /// starts anew from gravity, heading and bias stay. An acceleration that is not finite or too
  /// small corrects nothing, and the rate alone turns. False, and nothing happened but the time,
  /// which the next step makes up for: the rate is not finite; or dt_s is not above 0, and then not
  /// even the time.
  bool update(double dt_s, const InertialReading& reading);

  /// world_from_sensor, world y up. Before an up was seen, the heading alone.
  const Quat& orientation() const { return orientation_; }
  const Vec3& gyroscope_bias() const { return bias_; }  // rad/s
  bool has_tilt() const { return has_tilt_; }

 private:
  std::optional<Vec3> up_in_sensor(const Vec3& acceleration) const;
  void set_tilt(const Vec3& up, double heading);

  MahonyOptions options_;
  Quat orientation_;
  Vec3 bias_;
  double waiting_s_ = 0.0;  // time of readings that were left out
  bool has_tilt_ = false;
};

/// The rotation with this heading (rad, about +y) that brings `up_in_sensor` (unit) to +y by the
/// shortest way; of a sensor upside down, by half a turn about its x.
Quat tilted(const Vec3& up_in_sensor, double heading);

/// The heading in it: the turn about +y that is left when the tilt is taken off; rad, -pi to pi.
double heading_of(const Quat& world_from_sensor);

}  // namespace kinalign
