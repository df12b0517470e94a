// SPDX-License-Identifier: Apache-2.0
// A rotation curve with continuous angular rate and acceleration through rotations at irregular
// stamps: in each interval the rotation vector from the left knot is a cubic in time, and the
// angular rates at the knots solve a block tridiagonal system with a small nonlinear term, which
// is iterated, at most ten times: up to about a radian between knots that is more than enough,
// above two the curve is only nearly twice differentiable. The same curve as SciPy's RotationSpline
// (scipy/spatial/transform/_rotation_spline.py, after "Smooth Attitude Interpolation",
// github.com/scipy/scipy/files/2932755/attitude_interpolation.pdf); at both ends the rate is that
// of the first and the last interval.
#pragma once

#include <cstddef>
#include <span>

namespace kinalign {

/// Knots within this many of a place decide the curve there to 1e-12 rad, up to 2.5 rad between
/// knots: further ones to less than 1e-14, the rest is where the iteration ends.
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
