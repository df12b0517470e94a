// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/arrival_lines.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Returns whether the rows have a column in common. Their widths differ only if one is empty.
bool share(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  const std::size_t width = std::min(a.size(), b.size());
  for (std::size_t c = 0; c < width; ++c) {
    if (a[c] != 0 && b[c] != 0) return true;
  }
  return false;
}

}  // namespace

std::optional<std::size_t> ArrivalLines::line_of(std::int64_t t,
                                                 std::span<const std::uint8_t> seen) {
  // own: the newest line with one of these columns. ended: the newest line without a recent row.
  std::optional<std::size_t> own, ended;
  const auto later = [&](std::size_t i, std::optional<std::size_t> than) {
    return !than || lines_[i].t > lines_[*than].t;
  };
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    if (line.t && later(i, own) && share(line.seen, seen)) own = i;
    // After late_steps steps without a row, no row of this line can be found late.
    const bool over = !line.t || t - *line.t > late_steps * step_.ns;
    if (over && later(i, ended)) ended = i;
  }
  if (own || ended) return own ? own : ended;
  if (lines_.size() == most_lines) return std::nullopt;
  lines_.push_back({ArrivalSurveyor(step_.ns, step_.steady), {}, {}, {}});
  return lines_.size() - 1;
}

std::optional<std::int64_t> ArrivalLines::shown_late(std::size_t i, std::int64_t t) const {
  const Line& line = lines_[i];
  // The last condition accepts one row per step in a series of late rows. Otherwise a device whose
  // rate has increased would lose all its rows.
  const bool shows = line.t && t - *line.t < near_ns_ && line.arrivals.shows_late(t) &&
                     t - line.late_since.value_or(*line.t) < step_.ns;
  return shows ? line.t : std::nullopt;
}

void ArrivalLines::leave_out(std::size_t i) {
  Line& line = lines_[i];
  line.late_since = line.late_since.value_or(*line.t);
  // If before_[0] belongs to a row of another line, that row stays.
  if (before_[0].line == i) restore();
}

void ArrivalLines::add(std::size_t i, std::int64_t t, std::span<const std::uint8_t> seen) {
  Line& line = lines_[i];
  std::swap(before_[0], before_[1]);
  before_[0].line = i;
  before_[0].t = line.t;
  // swap() moves the old columns without copying and reuses the memory of the older state.
  std::swap(before_[0].seen, line.seen);
  line.t = t;
  line.seen.assign(seen.begin(), seen.end());
  line.arrivals.add(t);
}

void ArrivalLines::take_back() {
  // The newest row is removed, whatever its line is.
  lines_[before_[0].line].arrivals.take_back();
  restore();
}

void ArrivalLines::restore() {
  Line& line = lines_[before_[0].line];
  line.t = before_[0].t;
  std::swap(line.seen, before_[0].seen);
  std::swap(before_[0], before_[1]);
}

std::optional<std::int64_t> ArrivalLines::open_since(std::int64_t t) const {
  std::optional<std::int64_t> first;
  for (const Line& line : lines_) {
    // If this is false, later rows are too far from the line's last row to show a delay.
    const bool open = line.t && t - *line.t < near_ns_;
    if (open && (!first || line.t < first)) first = line.t;
  }
  return first;
}

Arrivals ArrivalLines::result() const {
  Arrivals all;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Arrivals one = lines_[i].arrivals.result();
    // The stream's first row belongs to the first line.
    if (i == 0) all.first_late = one.first_late;
    all.near += one.near;
    all.late += one.late;
    all.worst_late_ns = std::max(all.worst_late_ns, one.worst_late_ns);
    all.near_only = one.near_only;
  }
  return all;
}

}  // namespace kinalign
