// SPDX-License-Identifier: Apache-2.0
// Finds stretches of knots without a gap, and the rows of a grid within them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinalign {

/// Knots [first, last) without a gap between them, and the grid's rows [row, row_end) between the
/// first and the last knot's stamp, both included.
struct Segment {
  std::size_t first = 0, last = 0;
  std::size_t row = 0, row_end = 0;
};

/// `stamps` and `grid` must rise strictly. Segments without rows are left out.
/// A stretch longer than `gap_ns` separates two segments. A single knot can be a segment of one
/// row.
std::vector<Segment> find_segments(std::span<const std::int64_t> stamps,
                                   std::span<const std::int64_t> grid, std::int64_t gap_ns);

/// Seconds since `origin`. The numbers are small, so a double keeps picoseconds.
std::vector<double> seconds_from(std::int64_t origin, std::span<const std::int64_t> stamps);

}  // namespace kinalign
