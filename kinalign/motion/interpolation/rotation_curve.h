// SPDX-License-Identifier: Apache-2.0
// The rotation spline between its knots, its slopes known.
#pragma once

#include "kinalign/motion/interpolation/rotation_intervals.h"

#include <span>

namespace kinalign {

/// Of the knots [n+1], their intervals and slopes, what the curve needs.
struct RotationCurve {
  const RotationKnots& knots;
  const RotationIntervals& intervals;
  const RotationSlopes& slopes;
};

/// Fills `out` [N,4] with the curve's rotations at rising times within the knots' range.
void rotation_curve_at(const RotationCurve& curve, std::span<const double> at,
                       std::span<double> out);

}  // namespace kinalign
