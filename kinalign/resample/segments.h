// SPDX-License-Identifier: Apache-2.0
// Divides knots into segments without a gap, and finds the grid's rows in each segment.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

/// The knots [first, last) without a gap between them. The grid's rows [row, row_end) are between
/// the first and the last knot's stamp, both included.
struct Segment {
  std::size_t first = 0, last = 0;
  std::size_t row = 0, row_end = 0;
};

/// Returns the segments that contain rows. `stamps` and `grid` must rise strictly. A time without
/// knots that is longer than `gap_ns` separates two segments. A single knot can be a segment of one
/// row.
std::vector<Segment> find_segments(std::span<const std::int64_t> stamps,
                                   std::span<const std::int64_t> grid, std::int64_t gap_ns);

/// Returns the seconds since `origin`. The values are small, so a double is exact to picoseconds.
std::vector<double> seconds_from(std::int64_t origin, std::span<const std::int64_t> stamps);

}  // namespace kinalign
