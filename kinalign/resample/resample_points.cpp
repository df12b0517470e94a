// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/spline.h"
#include "kinalign/resample/resample.h"
#include "kinalign/resample/segments.h"

#include <algorithm>
#include <map>

namespace kinalign {

namespace {

using Joints = std::vector<std::size_t>;

/// Groups joints by the frames in which they were seen, because joints with the same frames can be
/// interpolated together. Usually there is one group.
std::map<std::vector<bool>, Joints> joints_by_seen(const PointFrames& rows, std::size_t joints) {
  std::map<std::vector<bool>, Joints> groups;
  std::vector<bool> seen(rows.size());
  for (std::size_t j = 0; j < joints; ++j) {
    for (std::size_t t = 0; t < rows.size(); ++t) {
      seen[t] = rows.state[t * joints + j] != Tracking::missing;
    }
    groups[seen].push_back(j);
  }
  return groups;
}

/// The samples [T', 3 |group|] of a group's joints, from the frames in which they were seen.
struct Gathered {
  const Joints* group = nullptr;
  std::vector<std::int64_t> stamps;
  std::vector<double> values;
};

/// All channels of the group are adjacent, so that the spline's equations are solved once for all.
Gathered gather(const Window<PointFrames>& window, const std::vector<bool>& seen,
                const Joints& group, std::size_t joints) {
  Gathered out;
  out.group = &group;
  for (std::size_t t = 0; t < seen.size(); ++t) {
    if (!seen[t]) continue;
    out.stamps.push_back(window.time_ns[t]);
    for (const std::size_t j : group) {
      const double* p = &window.rows.positions[(t * joints + j) * 3];
      out.values.insert(out.values.end(), p, p + 3);
    }
  }
  return out;
}

/// Computes one spline per segment for all channels of a group. Rows outside the segments stay
/// invalid.
void interpolate(const Gathered& samples, std::span<const std::int64_t> grid,
                 const ResampleRule& rule, PointRows& out, ResampleCount& count) {
  const Joints& group = *samples.group;
  const std::size_t joints = out.valid.size() / grid.size(), channels = 3 * group.size();
  // The memory of these arrays is reused for each segment.
  std::vector<double> bends, values;
  for (const Segment& s : find_segments(samples.stamps, grid, rule.gap_ns)) {
    const std::size_t knots = s.last - s.first, rows = s.row_end - s.row;
    const auto stamps = std::span(samples.stamps).subspan(s.first, knots);
    const auto x = seconds_from(stamps.front(), stamps);
    const auto at = seconds_from(stamps.front(), grid.subspan(s.row, rows));
    const Knots spline{x, std::span(samples.values).subspan(s.first * channels, knots * channels),
                       channels};
    bends.resize(knots * channels);
    natural_spline(spline, bends);
    values.resize(rows * channels);
    spline_at(spline, bends, at, values);
    for (std::size_t g = 0; rule.finer && g < group.size(); ++g) {
      count.positions.resize(joints);
      add_content(spline, {at, values, channels}, 3 * g, count.positions[group[g]]);
    }
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t g = 0; g < group.size(); ++g) {
        const std::size_t cell = (s.row + r) * joints + group[g];
        std::copy_n(&values[r * channels + 3 * g], 3, &out.positions[3 * cell]);
        out.valid[cell] = 1;
      }
    }
  }
}

/// Returns the stamps of the frames in which any joint was seen.
std::vector<std::int64_t> stamps_seen(const Window<PointFrames>& window) {
  std::vector<std::int64_t> out;
  for (std::size_t t = 0; t < window.time_ns.size(); ++t) {
    if (any_seen(window.rows, t)) out.push_back(window.time_ns[t]);
  }
  return out;
}

}  // namespace

Neighbours find_neighbours(std::span<const std::int64_t> stamps,
                           std::span<const std::int64_t> grid) {
  Neighbours out;
  std::size_t k = 0;
  for (const std::int64_t row : grid) {
    // Both lists rise, so k never decreases.
    while (k + 1 < stamps.size() && stamps[k + 1] <= row) ++k;
    const bool outside = stamps.empty() || row < stamps.front() || row > stamps.back();
    out.left.push_back(outside ? stamps.size() : k);
    out.known_by.push_back(k);
    std::int64_t nearest = farthest_nearest_ns;
    // The nearest sample is the last one at or before the row or the one after it.
    for (std::size_t i = k; i < std::min(k + 2, stamps.size()); ++i) {
      nearest = std::min(nearest, std::abs(row - stamps[i]));
    }
    out.nearest_raw_ns.push_back(nearest);
  }
  return out;
}

std::vector<std::int64_t> intervals_at(const TimeModel& clock, std::span<const Time> stamps,
                                       const Neighbours& near) {
  std::vector<std::int64_t> out;
  if (!any_known(clock)) return out;
  for (const std::size_t k : near.known_by) out.push_back(interval_ns(clock, stamps[k]));
  return out;
}

/// A row gets the worse state of its two neighbours. If a sample is missing between them, the row
/// is marked as interpolated over missing samples.
Result<void> PointResampler::rows(std::span<const std::int64_t> grid, PointRows& out) {
  out = {};
  if (grid.empty()) return {};
  KA_TRY(window_.move(grid.front(), grid.back(), rule_.reach()));
  const auto& stamps = window_.time_ns;
  if (stamps.empty()) return Failure(Error{"", 0, "samples in a stream of points", "none"});
  const std::size_t joints = window_.rows.state.size() / stamps.size();
  out.positions.assign(grid.size() * joints * 3, 0.0);
  out.state.assign(grid.size() * joints, Tracking::missing);
  out.valid.assign(grid.size() * joints, 0);
  out.distance.over_loss.assign(grid.size() * joints, 0);
  for (const auto& [seen, group] : joints_by_seen(window_.rows, joints)) {
    interpolate(gather(window_, seen, group, joints), grid, rule_, out, count_);
  }
  const Neighbours near = find_neighbours(stamps, grid);
  // A frame in which no joint was seen does not count for nearest_raw_ns. Its stamp still gives the
  // time interval.
  out.distance.nearest_raw_ns = find_neighbours(stamps_seen(window_), grid).nearest_raw_ns;
  out.distance.time_interval_ns = intervals_at(*clock_, window_.rows.stamps, near);
  for (std::size_t r = 0; r < grid.size(); ++r) {
    const std::size_t left = near.left[r];
    if (left == stamps.size()) continue;
    // A row at the stamp of a sample gets the state of that sample.
    const std::size_t right = stamps[left] == grid[r] ? left : left + 1;
    const bool lost = stamps[right] - stamps[left] > rule_.step_ns * 3 / 2;
    for (std::size_t j = 0; j < joints; ++j) {
      const std::size_t cell = r * joints + j;
      // The values of Tracking rise from missing to tracked.
      const Tracking lesser =
          std::min(window_.rows.state[left * joints + j], window_.rows.state[right * joints + j]);
      if (out.valid[cell] == 0) continue;
      out.state[cell] = lesser;
      out.distance.over_loss[cell] = lost || lesser == Tracking::missing ? 1 : 0;
    }
  }
  return {};
}

}  // namespace kinalign
