// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/axes.h"

#include <cassert>
#include <cmath>

namespace kinalign {

namespace {

/// A matrix whose columns are the file's axes in kinalign's axes.
Eigen::Matrix3d matrix_of(const Axes& axes) {
  Eigen::Matrix3d matrix;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vec3 unit = Vec3::Unit(i);
    matrix.col(i) = turned(axes, unit.data());
  }
  return matrix;
}

}  // namespace

int determinant(const Axes& axes) {
  // The elements of the matrix are whole numbers, so rounding gives the exact determinant.
  return static_cast<int>(std::lround(matrix_of(axes).determinant()));
}

Axes axes_of(const Axes& of_format, const StreamOptions& options) {
  // The user's option has priority over the format.
  if (options.up == "y") return y_up;
  if (options.up == "z") return z_up;
  return of_format;
}

Quat rotation_of(const Axes& axes) {
  assert(determinant(axes) == 1);
  return Quat(matrix_of(axes));
}

}  // namespace kinalign
