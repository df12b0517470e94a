// SPDX-License-Identifier: Apache-2.0
// Converts a file's samples of inertial nodes to our units, world axes and validity.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>

namespace kinalign {

/// Factors and axes that turn a file's samples into ours.
struct ImuUnits {
  Axes world = y_up;          // ours from the file's world; the sensors' own axes stay as they are
  double acceleration = 1.0;  // m/s2 per unit of the file
  double angular_velocity = 1.0;  // rad/s per unit of the file
};

/// One sample of a node as read from the file. nullptr: the stream has no such quantity.
struct RawImuSample {
  const double* orientation = nullptr;  // [4] w,x,y,z, of any length
  /// [3] in the file's unit and in sensor space, as is angular_velocity.
  const double* acceleration = nullptr;
  const double* angular_velocity = nullptr;
  bool valid = true;  // all present quantities were read
};

/// Appends samples in the order of the file: row after row, and node after node within a row.
class ImuConverter {
 public:
  explicit ImuConverter(const ImuUnits& units) : units_(units), turn_(rotation_of(units.world)) {}

  /// Appends one sample. A quaternion of length zero makes the sample invalid.
  void append(const RawImuSample& sample, ImuSamples& out);

  /// Adds findings about quaternions of length zero and of lengths other than 1, if there were any.
  void report(const std::string& file, Findings& findings) const;

 private:
  bool turn(const double* raw, Quat& q);

  ImuUnits units_;
  Quat turn_;
  std::uint64_t samples_ = 0, zero_ = 0, not_unit_ = 0;
};

}  // namespace kinalign
