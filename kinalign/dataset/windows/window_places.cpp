// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/windows/window_places.h"

#include "kinalign/motion/median.h"
#include "kinalign/motion/stamps.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Rows of a take that have no gap between them.
struct Stretch {
  std::uint64_t begin = 0, end = 0;
};

/// Cuts the rows of a take where a step is longer than 1.5 times the median.
std::vector<Stretch> stretches_of(std::span<const Time> stamps) {
  if (stamps.empty()) return {};
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  std::vector<Stretch> out{{0, stamps.size()}};
  if (steps.empty()) return out;
  const Duration median = upper_median(steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    // The comparison uses whole numbers. A step of exactly 1.5 medians is no gap.
    if (2 * steps[i] <= 3 * median) continue;
    out.back().end = i + 1;
    out.push_back({i + 1, stamps.size()});
  }
  return out;
}

/// The number of rows in a stretch, at the rate of the windows.
std::uint64_t grid_rows(std::span<const Time> stamps, const Stretch& stretch, double rate_hz) {
  if (rate_hz <= 0.0) return stretch.end - stretch.begin;
  const double seconds =
      std::chrono::duration<double>(stamps[stretch.end - 1] - stamps[stretch.begin]).count();
  // If rounding puts the last row slightly after the end, it still counts.
  constexpr double rounding = 1e-6;  // share of a row
  return static_cast<std::uint64_t>(seconds * rate_hz + rounding) + 1;
}

/// The window of `rows` rows that begins at row `offset` of the stretch, at the rate of the
/// windows.
WindowPlace place_at(std::span<const Time> stamps, const Stretch& stretch, double rate_hz,
                     std::uint64_t offset, std::uint64_t rows) {
  if (rate_hz <= 0.0) {
    const std::uint64_t first = stretch.begin + offset;
    return {stamps[first], first, rows, rows};
  }
  const auto stamp = [&](std::uint64_t row) {
    return grid_stamp(stamps[stretch.begin], rate_hz, row);
  };
  const Time begin = stamp(offset), end = stamp(offset + rows - 1);
  // These rows of the take are read: from the last one before the window to the first one after it.
  const auto before = std::upper_bound(stamps.begin(), stamps.end(), begin) - 1;
  const auto behind = std::min(std::lower_bound(before, stamps.end(), end), stamps.end() - 1);
  return {begin, static_cast<std::uint64_t>(before - stamps.begin()),
          static_cast<std::uint64_t>(behind - before) + 1, rows};
}

}  // namespace

WindowPlaces place_windows(std::span<const Time> stamps, const WindowGrid& grid) {
  WindowPlaces out;
  for (const Stretch& stretch : stretches_of(stamps)) {
    const std::uint64_t rows = grid_rows(stamps, stretch, grid.rate_hz);
    const auto add = [&](std::uint64_t offset, std::uint64_t count) {
      out.places.push_back(place_at(stamps, stretch, grid.rate_hz, offset, count));
    };
    if (rows < grid.length) {
      // A stretch shorter than a window gives one window with fewer rows. If it is shorter than
      // half a window, it gives none.
      if (2 * rows >= grid.length) add(0, rows);
      if (2 * rows < grid.length) out.rows_left_out += stretch.end - stretch.begin;
      continue;
    }
    std::uint64_t offset = 0;
    for (; offset + grid.length <= rows; offset += grid.step) add(offset, grid.length);
    // If the last window leaves rows at the end, one more window is added that ends with the
    // stretch.
    const bool has_rest = offset - grid.step + grid.length < rows;
    if (has_rest) add(rows - grid.length, grid.length);
  }
  return out;
}

}  // namespace kinalign
