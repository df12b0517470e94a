// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/imu_converter.h"

#include <cmath>

namespace kinalign {

namespace {

void append_scaled(const double* from, std::size_t count, double scale, std::vector<double>& to) {
  for (std::size_t i = 0; i < count; ++i) to.push_back(from[i] * scale);
}

constexpr double zeros[4] = {};

}  // namespace

/// Sets `q` to the orientation in kinalign's world, from the file's quaternion `raw` w,x,y,z.
/// Counts quaternions whose length is not 1. Returns false if the length is zero, because there is
/// then no direction.
bool ImuConverter::turn(const double* raw, Quat& q) {
  constexpr double smallest = 1e-6;
  constexpr double unit_within = 0.02;
  q = Quat(raw[0], raw[1], raw[2], raw[3]);
  const double length = q.norm();
  // A quaternion of length zero has no direction, so the sample can't be repaired.
  if (!(length > smallest)) {
    ++zero_;
    return false;
  }
  not_unit_ += std::abs(length - 1.0) > unit_within ? 1 : 0;
  // The rotation of the world is applied from the left. The sensor's own axes stay as they are.
  q = (turn_ * Quat(q.coeffs() / length)).normalized();
  return true;
}

void ImuConverter::append(const RawImuSample& sample, ImuSamples& out) {
  ++samples_;
  bool valid = sample.valid;
  if (sample.orientation != nullptr) {
    Quat q(1, 0, 0, 0);
    // An invalid sample contains zeros, whatever the file says.
    valid = valid && turn(sample.orientation, q);
    const double parts[] = {q.w(), q.x(), q.y(), q.z()};
    append_scaled(valid ? parts : zeros, 4, 1.0, out.orientation);
  }
  if (sample.acceleration != nullptr) {
    append_scaled(valid ? sample.acceleration : zeros, 3, units_.acceleration, out.acceleration);
  }
  if (sample.angular_velocity != nullptr) {
    append_scaled(valid ? sample.angular_velocity : zeros, 3, units_.angular_velocity,
                  out.angular_velocity);
  }
  out.valid.push_back(valid ? 1 : 0);
}

void ImuConverter::report(const std::string& file, Findings& findings) const {
  if (zero_ > 0) {
    add_note(findings,
             {file, 0, "quaternions of length 1",
              std::to_string(zero_) + " of " + std::to_string(samples_) + " samples with length 0"},
             "these samples are invalid");
  }
  if (not_unit_ > 0) {
    add_warning(findings,
                {file, 0, "quaternions of length 1",
                 std::to_string(not_unit_) + " of " + std::to_string(samples_) +
                     " samples that differ by more than 2 %"},
                "these quaternions were normalised", "check the columns in the layout");
  }
}

}  // namespace kinalign
