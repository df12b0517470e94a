// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/resample/resample.h"

#include <span>
#include <vector>

namespace kinalign {

/// The rotations [N,4] at the times `at` of the curve through `knots` [T,4] at `times` (see
/// rotation_spline.h and slerp.h in motion/interpolation/).
std::vector<double> rotations_at(RotationCurve curve, std::span<const double> times,
                                 std::span<const double> knots, std::span<const double> at);

}  // namespace kinalign
