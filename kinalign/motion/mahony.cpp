// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/mahony.h"

#include "kinalign/motion/rotation.h"

#include <cmath>

namespace kinalign {

Quat tilted(const Vec3& up_in_sensor, double heading) {
  const Vec3 up = Vec3::UnitY();
  // The half-way quaternion 1 + up.a + a x up is zero if a = -up.
  Quat tilt(1.0 + up_in_sensor.y(), 0.0, 0.0, 0.0);
  tilt.vec() = up_in_sensor.cross(up);
  if (tilt.squaredNorm() < 1e-24) tilt = Quat(0.0, 1.0, 0.0, 0.0);
  return rotation(Vec3(heading * up)) * tilt.normalized();
}

double heading_of(const Quat& world_from_sensor) {
  // A tilt from tilted() has no y component, so that component comes from the heading alone.
  return 2.0 * std::atan2(std::copysign(1.0, world_from_sensor.w()) * world_from_sensor.y(),
                          std::abs(world_from_sensor.w()));
}

MahonyFilter::MahonyFilter(const MahonyOptions& options)
    : options_(options),
      orientation_(rotation(Vec3(0.0, options.heading, 0.0))),
      bias_(options.gyroscope_bias) {}

std::optional<Vec3> MahonyFilter::up_in_sensor(const Vec3& acceleration) const {
  const double size = acceleration.norm();
  if (!std::isfinite(size) || size < options_.least_acceleration) return std::nullopt;
  return Vec3(acceleration / size);
}

void MahonyFilter::set_tilt(const Vec3& up, double heading) {
  orientation_ = tilted(up, heading);
  has_tilt_ = true;
}

bool MahonyFilter::update(double dt_s, const InertialReading& reading) {
  if (!(dt_s > 0.0)) return false;
  if (!reading.angular_velocity.allFinite()) {
    waiting_s_ += dt_s;
    return false;
  }
  // This step also covers the time of the readings that were ignored before it.
  const double step = dt_s + waiting_s_;
  waiting_s_ = 0.0;
  const std::optional<Vec3> up = up_in_sensor(reading.acceleration);
  if (!has_tilt_) {
    if (up) set_tilt(*up, options_.heading);
    return true;
  }
  if (step > options_.longest_step_s) {
    if (up) set_tilt(*up, heading_of(orientation_));
    return true;
  }
  // The correction is omega_mes = v x v^ of Mahony et al. (mahony.h). There v is the measured
  // direction of up, and v^ = orientation^T up.
  Vec3 correction = Vec3::Zero();
  if (up) correction = up->cross(orientation_.conjugate() * Vec3::UnitY());
  // The bias and the correction act on the rate, in the sensor's space.
  const Vec3 rate = reading.angular_velocity - bias_ + options_.tilt_gain * correction;
  orientation_ = (orientation_ * rotation(Vec3(step * rate))).normalized();
  bias_ -= options_.bias_gain * step * correction;
  return true;
}

}  // namespace kinalign
