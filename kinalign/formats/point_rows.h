// SPDX-License-Identifier: Apache-2.0
// Converts a file's joints or markers to our units, axes and tracking states.
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
  Axes axes = y_up;     // ours from the file's
  double metres = 1.0;  // per unit of the file
};

/// Unit and axes that the user states; the format's own where the user states none.
PointUnits point_units(const PointUnits& of_format, const StreamOptions& options);

/// Appends one row of joints: `file` [J,3] in the file's units and axes, `states` [J]. A missing
/// joint gets zeros.
void append_points(const PointUnits& units, const double* file, std::span<const Tracking> states,
                   PointFrames& out);

/// Detects a Kinect file that was mirrored. When a person faces the sensor, the left shoulder is at
/// smaller x (in 74,392 of 74,404 rows of a public set).
class MirrorWatch {
 public:
  explicit MirrorWatch(const std::vector<std::string>& joint_names);

  /// Counts one row of joints: `positions` [J,3], `states` [J].
  void watch(const double* positions, const Tracking* states);
  /// Adds a warning if the shoulders were mirrored in most rows.
  void report(const std::string& file, Findings& findings) const;

 private:
  std::size_t left_, right_;
  bool present_;
  std::uint64_t rows_ = 0, mirrored_ = 0;
};

}  // namespace kinalign
