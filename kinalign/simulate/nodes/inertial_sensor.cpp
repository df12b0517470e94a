// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): streams of a chip's seed: 110 and 111 are the noise of gyroscope and
// accelerometer (lanes 0, 2, 4), 112 the walks (lanes 0 to 10). 113 is scale, misalignment and
// zeros: number 0 for the gyroscope, 1 for the accelerometer; lanes 0 to 8 the matrix, 9 to 11 the
// zeros.
#include "kinalign/simulate/nodes/inertial_sensor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// Returns a uniform number from -most to most.
double evenly(const RandomStream& random, std::uint64_t number, std::uint64_t lane, double most) {
  return most * (2.0 * random.uniform(number, lane) - 1.0);
}

Vec3 normal(const RandomStream& random, std::uint64_t k, std::uint64_t lane) {
  return {random.normal(k, lane), random.normal(k, lane + 2), random.normal(k, lane + 4)};
}

// Diagonal elements: scale errors. Other elements: misalignment of an axis towards another axis.
Eigen::Matrix3d drawn_scale(const RandomStream& random, std::uint64_t number, double scale,
                            double misalignment) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double most = i % 4 == 0 ? scale : misalignment;
    matrix(i / 3, i % 3) += evenly(random, number, static_cast<std::uint64_t>(i), most);
  }
  return matrix;
}

Vec3 drawn_zero(const RandomStream& random, std::uint64_t number, double most) {
  return {evenly(random, number, 9, most), evenly(random, number, 10, most),
          evenly(random, number, 11, most)};
}

/// Rounds to multiples of range / 32768 and limits the value to the range.
std::array<std::int16_t, 3> quantised(const Vec3& value, double range) {
  std::array<std::int16_t, 3> raw{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double steps = std::nearbyint(value[static_cast<Eigen::Index>(i)] * (32768.0 / range));
    raw[i] = static_cast<std::int16_t>(std::clamp(steps, -32768.0, 32767.0));
  }
  return raw;
}

}  // namespace

ChipLowPass::ChipLowPass(double bandwidth_hz) {
  // Each pole is at bandwidth / sqrt(sqrt(2) - 1), so that both together give -3 dB at the
  // bandwidth.
  const double pole = 2.0 * std::numbers::pi * bandwidth_hz / std::sqrt(std::numbers::sqrt2 - 1.0);
  const double w = pole * chip_step_s;
  take_ = w / (2.0 + w);
  keep_ = (2.0 - w) / (2.0 + w);
}

const Vec3& ChipLowPass::push(const Vec3& value) {
  if (!begun_) before_ = out_ = {value, value};
  begun_ = true;
  Vec3 in = value;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 out = keep_ * out_[k] + take_ * (in + before_[k]);
    before_[k] = in;
    in = out_[k] = out;
  }
  return out_[1];
}

SimulatedSensor::SimulatedSensor(const InertialSensorModel& model, std::uint64_t seed)
    : model_(model),
      gyroscope_noise_(seed, 110),
      accelerometer_noise_(seed, 111),
      walks_(seed, 112),
      gyroscope_(model.gyroscope_bandwidth_hz),
      accelerometer_(model.accelerometer_bandwidth_hz) {
  const RandomStream chip(seed, 113);
  errors_.gyroscope_scale = drawn_scale(chip, 0, model.gyroscope_scale, model.misalignment);
  errors_.gyroscope_zero = drawn_zero(chip, 0, model.gyroscope_zero);
  errors_.accelerometer_scale = drawn_scale(chip, 1, model.accelerometer_scale, model.misalignment);
  errors_.accelerometer_zero = drawn_zero(chip, 1, model.accelerometer_zero);
}

void SimulatedSensor::wait(double seconds) {
  walk(seconds);
  gyroscope_ = ChipLowPass(model_.gyroscope_bandwidth_hz);
  accelerometer_ = ChipLowPass(model_.accelerometer_bandwidth_hz);
}

// A random walk grows with the square root of time, so one draw suffices for any duration.
void SimulatedSensor::walk(double seconds) {
  const double root = std::sqrt(seconds);
  errors_.gyroscope_zero += model_.gyroscope_walk * root * normal(walks_, walked_, 0);
  errors_.accelerometer_zero += model_.accelerometer_walk * root * normal(walks_, walked_, 6);
  ++walked_;
}

RawReading SimulatedSensor::step(const InertialReading& truth) {
  walk(chip_step_s);
  // The noise density applies up to half of the chip's rate.
  const double band = std::sqrt(0.5 * chip_rate_hz);
  const Vec3 rate = errors_.gyroscope_scale * truth.angular_velocity + errors_.gyroscope_zero +
                    model_.gyroscope_noise * band * normal(gyroscope_noise_, steps_, 0);
  const Vec3 force = errors_.accelerometer_scale * truth.acceleration + errors_.accelerometer_zero +
                     model_.accelerometer_noise * band * normal(accelerometer_noise_, steps_, 0);
  ++steps_;
  return {quantised(accelerometer_.push(force), model_.accelerometer_range),
          quantised(gyroscope_.push(rate), model_.gyroscope_range)};
}

// Computed in float in the same order as in the firmware, so that all bits of the values agree.
NodeSample SimulatedSensor::sample_of(const RawReading& reading) const {
  const auto acceleration_step = static_cast<float>(model_.accelerometer_range / 32768.0);
  const auto angular_velocity_step = static_cast<float>(model_.gyroscope_range / 32768.0);
  NodeSample sample;
  sample.has_acceleration = sample.has_angular_velocity = sample.gravity_included = true;
  for (std::size_t i = 0; i < 3; ++i) {
    sample.acceleration[i] = static_cast<float>(reading.acceleration[i]) * acceleration_step;
    sample.angular_velocity[i] =
        static_cast<float>(reading.angular_velocity[i]) * angular_velocity_step;
  }
  return sample;
}

InertialReading SimulatedSensor::reading_of(const RawReading& reading) const {
  const NodeSample sample = sample_of(reading);
  const auto& a = sample.acceleration;
  const auto& w = sample.angular_velocity;
  return {Vec3(w[0], w[1], w[2]), Vec3(a[0], a[1], a[2])};
}

}  // namespace kinalign
