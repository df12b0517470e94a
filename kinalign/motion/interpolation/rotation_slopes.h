// SPDX-License-Identifier: Apache-2.0
// Two ways to the same slopes. In the paper's symbols (see rotation_spline.h), for the interval
// from knot k to k + 1: r its rotation vector, h its length; W and b as in rotation_intervals.h.
// Continuous angular acceleration at knot k demands of the angular rates w
//   2/h' W(r') w[k-1] + 4 (1/h' + 1/h) w[k] + 2/h W(r)^-1 w[k+1]
//       = 6 (r'/h'^2 + r/h^2) - b(r', w[k])
// with ' for the interval before; b is small and is iterated. An interval begins with the slope w
// and ends with W(r)^-1 w.
#pragma once

#include "kinalign/motion/interpolation/rotation_intervals.h"

namespace kinalign {

/// The slopes as SciPy finds them, whatever the intervals; one at least. Fills `to`, as long as
/// they.
void slopes_by_blocks(const RotationIntervals& intervals, RotationSlopes& to);

/// The same in a tenth of the time, where there are hundreds of intervals and they turn by less
/// than about a radian; false, and nothing of use in `to`, elsewhere.
bool slopes_in_lanes(const RotationIntervals& intervals, RotationSlopes& to);

}  // namespace kinalign
