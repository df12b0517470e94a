// SPDX-License-Identifier: Apache-2.0
// From what a file says of joints or markers to our units, axes and states.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/motion/streams.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

struct PointUnits {
  Axes axes = y_up;  // ours from the file's
  double metres = 1.0;
};

/// What the user says of unit and axes, else the format's own.
PointUnits point_units(const PointUnits& of_format, const StreamOptions& options);

/// Appends a row of joints, [J,3] as in the file and [J]; a missing one gets zeros.
void append_points(const PointUnits& units, const double* file, std::span<const Tracking> states,
                   PointFrames& out);

/// Notices a Kinect file that was mirrored: facing the sensor, the person's left shoulder is at
/// smaller x (in 74,392 of 74,404 rows of a public set).
class MirrorWatch {
 public:
  explicit MirrorWatch(const std::vector<std::string>& joint_names);

  /// One row's joints, [J,3] and [J].
  void watch(const double* positions, const Tracking* states);
  void report(const std::string& file, Findings& findings) const;

 private:
  std::size_t left_, right_;
  bool present_;
  std::uint64_t rows_ = 0, mirrored_ = 0;
};

}  // namespace kinalign
