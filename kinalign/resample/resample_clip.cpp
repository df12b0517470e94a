// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/spline.h"
#include "kinalign/resample/resample.h"
#include "kinalign/resample/rotation_rows.h"
#include "kinalign/resample/segments.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Returns the rotations [T',4] of one joint in consecutive frames.
std::vector<double> column(const std::vector<double>& rotations, std::size_t joints, std::size_t j,
                           std::size_t first, std::size_t last) {
  std::vector<double> out;
  for (std::size_t t = first; t < last; ++t) {
    const double* q = &rotations[(t * joints + j) * 4];
    out.insert(out.end(), q, q + 4);
  }
  return out;
}

/// Computes the rows of one segment.
void resample(const Segment& s, const Window<ClipFrames>& window,
              std::span<const std::int64_t> grid, RotationCurve curve, ClipRows& out) {
  const std::size_t knots = s.last - s.first, rows = s.row_end - s.row;
  const std::span stamps(window.time_ns);
  // The block does not contain the number of joints, so it is computed from the sizes of the
  // arrays.
  const std::size_t channels = window.rows.local_positions.size() / stamps.size();
  const std::size_t joints = channels / 3;
  const auto x = seconds_from(stamps[s.first], stamps.subspan(s.first, knots));
  const auto at = seconds_from(stamps[s.first], grid.subspan(s.row, rows));
  const Knots spline{
      x, std::span(window.rows.local_positions).subspan(s.first * channels, knots * channels),
      channels};
  // Second derivatives at the knots.
  std::vector<double> bends(knots * channels);
  natural_spline(spline, bends);
  spline_at(spline, bends, at,
            std::span(out.local_positions).subspan(s.row * channels, rows * channels));
  for (std::size_t j = 0; j < joints; ++j) {
    const auto turned =
        rotations_at(curve, x, column(window.rows.local_rotations, joints, j, s.first, s.last), at);
    for (std::size_t r = 0; r < rows; ++r) {
      std::copy_n(&turned[4 * r], 4, &out.local_rotations[4 * ((s.row + r) * joints + j)]);
    }
  }
  std::fill(&out.valid[s.row], &out.valid[s.row] + rows, std::uint8_t{1});
}

}  // namespace

Result<void> ClipResampler::rows(std::span<const std::int64_t> grid, ClipRows& out) {
  out = {};
  if (grid.empty()) return {};
  KA_TRY(window_.move(grid.front(), grid.back(), rule_.reach()));
  const auto& stamps = window_.time_ns;
  if (stamps.empty()) return Failure(Error{"", 0, "frames in a clip", "none"});
  const std::size_t channels = window_.rows.local_positions.size() / stamps.size();
  // Rows outside all segments stay zero and invalid.
  out.local_positions.assign(grid.size() * channels, 0.0);
  out.local_rotations.assign(grid.size() * channels / 3 * 4, 0.0);
  out.valid.assign(grid.size(), 0);
  for (const Segment& s : find_segments(stamps, grid, rule_.gap_ns)) {
    resample(s, window_, grid, rule_.curve, out);
  }
  Neighbours near = find_neighbours(stamps, grid);
  out.distance.time_interval_ns = intervals_at(*clock_, window_.rows.stamps, near);
  out.distance.nearest_raw_ns = std::move(near.nearest_raw_ns);
  return {};
}

}  // namespace kinalign
