// SPDX-License-Identifier: Apache-2.0
// From what a file says of inertial nodes to our units, world and validity.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>

namespace kinalign {

/// How a file's samples become ours.
struct ImuUnits {
  Axes world = y_up;              // ours from the file's world; sensor spaces stay as they are
  double acceleration = 1.0;      // m/s2
  double angular_velocity = 1.0;  // rad/s
};

/// One node's sample as read; nullptr: the quantity is absent from the stream.
struct RawImuSample {
  const double* orientation = nullptr;  // [4] w,x,y,z, of any length
  const double* acceleration = nullptr;
  const double* angular_velocity = nullptr;
  bool valid = true;  // all present quantities were read
};

/// Appends nodes' samples one after the other, node after node within a row.
class ImuConverter {
 public:
  explicit ImuConverter(const ImuUnits& units) : units_(units), turn_(rotation_of(units.world)) {}

  /// A quaternion that is zero makes the sample invalid.
  void append(const RawImuSample& sample, ImuSamples& out);

  /// What was odd about the quaternions, if anything was.
  void report(const std::string& file, Findings& findings) const;

 private:
  bool turn(const double* raw, Quat& q);

  ImuUnits units_;
  Quat turn_;
  std::uint64_t samples_ = 0, zero_ = 0, not_unit_ = 0;
};

}  // namespace kinalign
