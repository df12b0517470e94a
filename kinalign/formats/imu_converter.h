// SPDX-License-Identifier: Apache-2.0
// Converts a file's samples of inertial nodes to kinalign's units and axes, and marks invalid
// samples.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>

namespace kinalign {

/// The axes and factors that convert a file's samples.
struct ImuUnits {
  Axes world = y_up;              // from the file's world to kinalign's; the sensors' own axes stay
  double acceleration = 1.0;      // m/s2 per unit of the file
  double angular_velocity = 1.0;  // rad/s per unit of the file
};

/// One sample of a node as in the file. nullptr: the stream does not have this quantity.
struct RawImuSample {
  const double* orientation = nullptr;  // [4] w,x,y,z, of any length
  /// [3] in the file's unit, in sensor space. The same applies to angular_velocity.
  const double* acceleration = nullptr;
  const double* angular_velocity = nullptr;
  bool valid = true;  // false if a present quantity could not be read
};

/// Appends samples in the order of the file: all nodes of a row, then the next row.
class ImuConverter {
 public:
  explicit ImuConverter(const ImuUnits& units) : units_(units), turn_(rotation_of(units.world)) {}

  /// Appends one sample. If the length of its quaternion is zero, the sample is invalid.
  void append(const RawImuSample& sample, ImuSamples& out);

  /// Adds findings if quaternions had the length zero or another length than 1.
  void report(const std::string& file, Findings& findings) const;

 private:
  bool turn(const double* raw, Quat& q);

  ImuUnits units_;
  Quat turn_;
  std::uint64_t samples_ = 0, zero_ = 0, not_unit_ = 0;
};

}  // namespace kinalign
