// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/imu_rows.h"

#include <cmath>

namespace kinalign {

namespace {

void append_scaled(const double* from, std::size_t count, double scale, std::vector<double>& to) {
  for (std::size_t i = 0; i < count; ++i) to.push_back(from[i] * scale);
}

constexpr double zeros[4] = {};

}  // namespace

void ImuRows::append(const RawImuSample& sample, ImuSamples& out) {
  constexpr double smallest = 1e-6;
  constexpr double unit_within = 0.02;
  bool valid = sample.valid;
  Quat q(1, 0, 0, 0);
  if (const double* raw = sample.orientation; raw != nullptr && valid) {
    q = Quat(raw[0], raw[1], raw[2], raw[3]);
    const double length = q.norm();
    valid = length > smallest;
    zero_ += valid ? 0 : 1;
    not_unit_ += valid && std::abs(length - 1.0) > unit_within ? 1 : 0;
    if (valid) q = (turn_ * Quat(q.coeffs() / length)).normalized();
  }
  ++samples_;
  const double scale = valid ? 1.0 : 0.0;
  if (sample.orientation != nullptr) {
    for (const double part : {q.w(), q.x(), q.y(), q.z()})
      out.orientation.push_back(valid ? part : 0.0);
  }
  if (sample.acceleration != nullptr) {
    append_scaled(valid ? sample.acceleration : zeros, 3, scale * units_.acceleration,
                  out.acceleration);
  }
  if (sample.angular_velocity != nullptr) {
    append_scaled(valid ? sample.angular_velocity : zeros, 3, scale * units_.angular_velocity,
                  out.angular_velocity);
  }
  out.valid.push_back(valid ? 1 : 0);
}

void ImuRows::report(const std::string& file, Findings& findings) const {
  if (zero_ > 0) {
    findings.push_back({Severity::note,
                        Error{file, 0, "quaternions of length 1",
                              std::to_string(zero_) + " of " + std::to_string(samples_) +
                                  " samples with a zero one"},
                        "these samples are invalid", ""});
  }
  if (not_unit_ > 0) {
    findings.push_back({Severity::warning,
                        Error{file, 0, "quaternions of length 1",
                              std::to_string(not_unit_) + " of " + std::to_string(samples_) +
                                  " off by more than 2 %"},
                        "they were brought to length 1",
                        "check that the layout names the right columns"});
  }
}

}  // namespace kinalign
