// SPDX-License-Identifier: Apache-2.0
// A rotation curve with continuous angular rate and acceleration through rotations at irregular
// stamps. In each interval the rotation vector from the left knot is a cubic in time. The angular
// rates at the knots solve a block tridiagonal system with a small nonlinear term, which is
// iterated at most ten times. That suffices up to about one radian between knots; above two radians
// the curve is only approximately twice differentiable.
//
// The curve equals that of SciPy's RotationSpline (scipy/spatial/transform/_rotation_spline.py,
// after "Smooth Attitude Interpolation",
// github.com/scipy/scipy/files/2932755/attitude_interpolation.pdf). At the first and the last knot
// the angular rate is the mean rate of the adjacent interval.
#pragma once

#include <cstddef>
#include <span>

namespace kinalign {

/// This many knots on each side of a place determine the curve there to 1e-12 rad, if neighbouring
/// knots differ by at most 2.5 rad. Knots farther away change the curve by less than 1e-14 rad; the
/// remaining error is that of the iteration.
constexpr std::size_t rotation_spline_reach = 60;

/// `knots` [T,4] unit w,x,y,z at strictly rising `times` [T] s, T >= 1.
struct RotationKnots {
  std::span<const double> times;
  std::span<const double> rotations;
};

/// Fills `out` [N,4] with the curve's rotations at rising times within the knots' range.
void rotation_spline_at(const RotationKnots& knots, std::span<const double> at,
                        std::span<double> out);

}  // namespace kinalign
