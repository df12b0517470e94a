// SPDX-License-Identifier: Apache-2.0
// Two methods that find the same slopes. The symbols are those of "Smooth Attitude Interpolation"
// (address in rotation_spline.h). For the interval from knot k to k + 1, r is its rotation vector
// and h its length; W and b are defined in rotation_intervals.h. The angular acceleration is
// continuous at knot k if the angular rates w satisfy
//   2/h' W(r') w[k-1] + 4 (1/h' + 1/h) w[k] + 2/h W(r)^-1 w[k+1]
//       = 6 (r'/h'^2 + r/h^2) - b(r', w[k])
// where ' marks the previous interval. The term b is small and is iterated. An interval begins with
// the slope w and ends with W(r)^-1 w.
#pragma once

#include "kinalign/motion/interpolation/rotation_intervals.h"

namespace kinalign {

/// Finds the slopes as SciPy does, for at least one interval of any length. `to` must have as many
/// elements as `intervals`.
void slopes_by_blocks(const RotationIntervals& intervals, RotationSlopes& to);

/// Finds the same slopes in a tenth of the time, if there are hundreds of intervals with rotations
/// of less than about a radian. Returns false in other cases; `to` is then undefined.
bool slopes_in_lanes(const RotationIntervals& intervals, RotationSlopes& to);

}  // namespace kinalign
