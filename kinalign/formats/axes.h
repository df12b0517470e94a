// SPDX-License-Identifier: Apache-2.0
// Converts a file's axes to kinalign's axes (right-handed, y up). Each axis of kinalign must be an
// axis of the file, perhaps with the opposite sign.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/take/manifest.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace kinalign {

/// kinalign's axes in terms of the file's axes. Coordinate k in kinalign is the file's coordinate
/// |axes[k]| (counted from 1), times the sign of axes[k]. Coordinates are only reordered and change
/// signs, so no digit is lost.
using Axes = std::array<int, 3>;

constexpr Axes y_up{1, 2, 3};
constexpr Axes z_up{1, 3, -2};  // x, z, -y: a rotation by -90 degrees about x

/// Converts the point `file` [3] from the file's axes to kinalign's axes.
inline Vec3 turned(const Axes& axes, const double* file) {
  // No matrix product is needed: each coordinate is copied or changes its sign.
  Vec3 ours;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(axes[k] < 0 ? -axes[k] : axes[k]) - 1;
    ours[static_cast<Eigen::Index>(k)] = axes[k] < 0 ? -file[i] : file[i];
  }
  return ours;
}

/// The determinant of the conversion. +1: right-handed stays right-handed. -1: a mirror image. 0:
/// an axis occurs twice.
int determinant(const Axes& axes);

/// The axes for the upward axis in the user's options, or the format's own axes without this
/// option.
Axes axes_of(const Axes& of_format, const StreamOptions& options);

/// The same conversion as a rotation. The determinant must be +1.
Quat rotation_of(const Axes& axes);

}  // namespace kinalign
