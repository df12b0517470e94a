// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/resample/resample.h"

#include <span>
#include <vector>

namespace kinalign {

/// Returns the rotations [N,4] at the times `at`, on the curve through `knots` [T,4] at `times`
/// (rotation_spline.h and slerp.h in motion/interpolation/).
std::vector<double> rotations_at(RotationCurve curve, std::span<const double> times,
                                 std::span<const double> knots, std::span<const double> at);

}  // namespace kinalign
