// SPDX-License-Identifier: Apache-2.0
// The intervals between neighbouring rotations, as the rotation spline sees them; its own header.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/rotation_spline.h"

#include <array>
#include <vector>

namespace kinalign {

using Columns = std::array<std::vector<double>, 3>;  // x, y, z apart: loops become vector code

/// Of each interval the rotation vector r from its left knot to its right one, and what depends on
/// its length alone: with W(r), which turns the derivative of a rotation vector into an angular
/// rate,
///   W(r) v = v - rate1 r x v + rate2 r x (r x v)
///   W(r)^-1 v = v + 1/2 r x v + back2 r x (r x v)
/// and the part of the angular acceleration that is quadratic in the derivative v of r
///   b = (r . v) (bend1 c + bend2 r x c) + rate2 v x c, where c = r x v.
struct RotationIntervals {
  std::vector<double> length;                             // [n] s
  Columns vector;                                         // [n] r, at most pi long
  std::vector<double> rate1, rate2, back2, bend1, bend2;  // [n]

  explicit RotationIntervals(const RotationKnots& knots);
  std::size_t size() const { return length.size(); }
  Vec3 r(std::size_t i) const { return {vector[0][i], vector[1][i], vector[2][i]}; }
};

}  // namespace kinalign
