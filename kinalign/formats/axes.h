// SPDX-License-Identifier: Apache-2.0
// Turning a file's axes into ours (right-handed, y up) where each of ours is one of the file's,
// perhaps with the other sign.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/take/manifest.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace kinalign {

/// Ours from the file's: our k-th coordinate is the file's |axes[k]|-th, from 1, with its sign.
using Axes = std::array<int, 3>;

constexpr Axes y_up{1, 2, 3};
constexpr Axes z_up{1, 3, -2};  // x, z, -y: a quarter turn about x

inline Vec3 turned(const Axes& axes, const double* file) {
  Vec3 ours;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(axes[k] < 0 ? -axes[k] : axes[k]) - 1;
    ours[static_cast<Eigen::Index>(k)] = axes[k] < 0 ? -file[i] : file[i];
  }
  return ours;
}

/// +1: right-handed stays right-handed; -1: a mirror image; 0: an axis stands twice.
int determinant(const Axes& axes);

/// What the user says is up, else the format's own axes.
Axes axes_of(const Axes& of_format, const StreamOptions& options);

/// The same turn as a rotation; the determinant must be +1.
Quat rotation_of(const Axes& axes);

}  // namespace kinalign
