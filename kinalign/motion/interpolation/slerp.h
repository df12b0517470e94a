// SPDX-License-Identifier: Apache-2.0
// Spherical linear interpolation at given times (Shoemake, SIGGRAPH 1985, section 3.3).
#pragma once

#include <span>

namespace kinalign {

/// Fills `out` [N,4] with the rotations at rising times within [times.front(), times.back()], with
/// constant angular rate on the shorter arc between neighbouring knots. `knots` [T,4]: unit w,x,y,z
/// at strictly rising `times` [T], s; T >= 1; N may be 0.
void slerp_at(std::span<const double> times, std::span<const double> knots,
              std::span<const double> at, std::span<double> out);

}  // namespace kinalign
