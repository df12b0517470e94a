// SPDX-License-Identifier: Apache-2.0
// Turns a file's axes into ours (right-handed, y up). Each of our axes must be one of the file's
// axes, perhaps with the other sign.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/take/manifest.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace kinalign {

/// Our axes in terms of the file's. Our coordinate k is the file's coordinate |axes[k]|,
/// counted from 1, times the sign of axes[k].
/// A file's axes and ours differ by a permutation with signs, so no digit is lost.
using Axes = std::array<int, 3>;

constexpr Axes y_up{1, 2, 3};
constexpr Axes z_up{1, 3, -2};  // x, z, -y: a quarter turn about x

/// Point `file` [3], in the file's axes, in ours.
inline Vec3 turned(const Axes& axes, const double* file) {
  // No matrix product: a coordinate is copied or changes its sign.
  Vec3 ours;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(axes[k] < 0 ? -axes[k] : axes[k]) - 1;
    ours[static_cast<Eigen::Index>(k)] = axes[k] < 0 ? -file[i] : file[i];
  }
  return ours;
}

/// Determinant of the turn. +1: right-handed stays right-handed; -1: a mirror image; 0: an axis
/// stands twice.
int determinant(const Axes& axes);

/// The axes for the upward axis that the user states; without such an option the format's own axes.
Axes axes_of(const Axes& of_format, const StreamOptions& options);

/// The same turn as a rotation; the determinant must be +1.
Quat rotation_of(const Axes& axes);

}  // namespace kinalign
