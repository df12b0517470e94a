// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/segments.h"

#include <algorithm>

namespace kinalign {

std::vector<Segment> find_segments(std::span<const std::int64_t> stamps,
                                   std::span<const std::int64_t> grid, std::int64_t gap_ns) {
  std::vector<Segment> segments;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= stamps.size(); ++i) {
    // The last segment ends at i == stamps.size().
    if (i < stamps.size() && stamps[i] - stamps[i - 1] <= gap_ns) continue;
    // Rows outside the segment's knots would have to be extrapolated, so they are not included.
    const auto row = std::lower_bound(grid.begin(), grid.end(), stamps[first]);
    const auto end = std::upper_bound(row, grid.end(), stamps[i - 1]);
    if (row != end) {
      segments.push_back({first, i, static_cast<std::size_t>(row - grid.begin()),
                          static_cast<std::size_t>(end - grid.begin())});
    }
    first = i;
  }
  return segments;
}

std::vector<double> seconds_from(std::int64_t origin, std::span<const std::int64_t> stamps) {
  std::vector<double> out(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    // The subtraction uses integers, because seconds since 1970 as doubles would lose nanoseconds.
    out[i] = static_cast<double>(stamps[i] - origin) * 1e-9;
  }
  return out;
}

}  // namespace kinalign
