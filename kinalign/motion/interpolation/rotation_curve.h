// SPDX-License-Identifier: Apache-2.0
// Evaluates the rotation spline between its knots when its slopes are known.
#pragma once

#include "kinalign/motion/interpolation/rotation_intervals.h"

#include <span>

namespace kinalign {

/// The curve: its knots [n+1], their intervals and slopes.
struct RotationCurve {
  const RotationKnots& knots;
  const RotationIntervals& intervals;
  const RotationSlopes& slopes;
};

/// Fills `out` [N,4] with the curve's rotations at rising times within the knots' range.
void rotation_curve_at(const RotationCurve& curve, std::span<const double> at,
                       std::span<double> out);

}  // namespace kinalign
