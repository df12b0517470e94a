// SPDX-License-Identifier: Apache-2.0
// Processes the knots in windows, so that a window's data stay in the second-level cache and memory
// does not grow with the number of knots.
#include "kinalign/motion/interpolation/rotation_spline.h"

#include "kinalign/motion/interpolation/rotation_curve.h"
#include "kinalign/motion/interpolation/rotation_slopes.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t window = 2048;  // intervals, 240 bytes each during the solution

/// Knots [begin, end).
RotationKnots part(const RotationKnots& knots, std::size_t begin, std::size_t end) {
  return {knots.times.subspan(begin, end - begin),
          knots.rotations.subspan(4 * begin, 4 * (end - begin))};
}

}  // namespace

void rotation_spline_at(const RotationKnots& knots, std::span<const double> at,
                        std::span<double> out) {
  const auto& t = knots.times;
  if (t.size() == 1) {
    for (std::size_t i = 0; i < at.size(); ++i)
      std::copy_n(knots.rotations.begin(), 4, &out[4 * i]);
    return;
  }
  RotationIntervals intervals;
  RotationSlopes slopes;
  std::size_t sample = 0;
  for (std::size_t first = 0; first + 1 < t.size() && sample < at.size(); first += window) {
    // The knots near the window's ends depend on knots beyond them.
    const std::size_t begin = first < rotation_spline_reach ? 0 : first - rotation_spline_reach;
    const std::size_t behind = first + window;
    const RotationKnots near =
        part(knots, begin, std::min(t.size(), behind + rotation_spline_reach));
    measure_intervals(near, intervals);
    for (auto& column : slopes.begin) column.resize(intervals.size());
    for (auto& column : slopes.end) column.resize(intervals.size());
    if (!slopes_in_lanes(intervals, slopes)) slopes_by_blocks(intervals, slopes);
    // A sample at a window's end belongs to the next window, except at the curve's end.
    const auto end =
        behind + 1 < t.size() ? std::lower_bound(at.begin(), at.end(), t[behind]) : at.end();
    const auto count = static_cast<std::size_t>(end - at.begin()) - sample;
    rotation_curve_at({near, intervals, slopes}, at.subspan(sample, count),
                      out.subspan(4 * sample, 4 * count));
    sample += count;
  }
}

}  // namespace kinalign
