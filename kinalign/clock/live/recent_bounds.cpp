// SPDX-License-Identifier: Apache-2.0
// On a new route the delays have the usual distribution above another floor. On a busy radio link
// the delays are long for some time. Their spread is then greater than the rise of the least delay.
#include "kinalign/clock/live/recent_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

constexpr std::array windows_s{1.0, 3.0, 9.0};
constexpr std::size_t least_points = 6;
// The floor must have moved by at least this number, divided by the seconds watched, times the
// spread of the delays.
constexpr double steepness_s = 2.0;
constexpr double least_steepness = 1.0;  // smallest value of that factor
// Number of bounds between two checks, because a check over nine seconds is slow.
constexpr std::size_t asked_each = 3;
constexpr double silent_steps = 2.5;
constexpr double least_gap_s = 1e-3;
constexpr double sure_nats = 25.0;  // required evidence against the old floor

/// Returns the evidence that `points` delays of at least `excess` above a floor don't belong to
/// this floor.
double nats(const ExcessCounts& counts, std::size_t points, double excess) {
  const auto n = static_cast<double>(points);
  const double others = static_cast<double>(counts.total()) - n;
  const double above = static_cast<double>(counts.above(excess)) - n;
  if (others < 20.0) return 0.0;
  return n * std::log((others + 2.0) / (std::max(above, 0.0) + 1.0));
}

}  // namespace

void RecentBounds::add(OffsetBound bound, Standing standing) {
  entries_[next_] = {bound, standing};
  next_ = (next_ + 1) % capacity;
  size_ = std::min(size_ + 1, capacity);
  above_run_ = standing == Standing::above ? std::min(above_run_ + 1, capacity) : 0;
  if (since_held_ > 0 || standing == Standing::held) {
    since_held_ = std::min(since_held_ + 1, capacity);
  }
}

std::optional<double> RecentBounds::moved(const FloorLine& line, const ExcessCounts& counts) const {
  const bool below = since_held_ > 0;
  const std::size_t all = below ? since_held_ : above_run_;
  if (all < least_points || all % asked_each != 0) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  std::size_t points = 0;
  for (const double window : windows_s) {
    if (newest(0).s - newest(all - 1).s < window) return std::nullopt;
    const double begin = below ? newest(all - 1).s : newest(0).s - window;
    for (; points < all && newest(points).s >= begin; ++points) {
      least = std::min(least, line.excess(newest(points)));
    }
    if (points < least_points) continue;
    const bool sure = below || nats(counts, points, least) > sure_nats;
    if (!sure || !another_floor({points, least}, window, line, counts)) continue;
    while (points < all && line.excess(newest(points)) >= least) ++points;
    return before(points - 1);
  }
  return std::nullopt;
}

/// Returns whether half of the bounds are near the lowest one. "Near" means closer than the usual
/// delays, and closer than the lowest one has risen.
bool RecentBounds::another_floor(const Level& level, double window_s, const FloorLine& line,
                                 const ExcessCounts& counts) const {
  const double steepness = std::max(steepness_s / window_s, least_steepness);
  const double near = level.least + std::min(std::abs(level.least) / steepness, counts.median());
  std::size_t nearer = 0;
  for (std::size_t i = 0; i < level.points; ++i) {
    nearer += line.excess(newest(i)) < near ? 1 : 0;
  }
  return nearer > level.points / 2;
}

std::size_t RecentBounds::behind(double s) const {
  std::size_t count = 0;
  while (count < size_ && newest(count).s > s) ++count;
  return count;
}

double RecentBounds::before(std::size_t i) const {
  return i + 1 < size_ ? (newest(i).s + newest(i + 1).s) / 2.0 : newest(i).s - least_gap_s;
}

bool RecentBounds::silent_around(double s) const {
  std::size_t i = 0;
  while (i + 1 < size_ && newest(i + 1).s > s) ++i;
  if (i + 1 >= size_) return true;
  const double mean = (newest(0).s - newest(size_ - 1).s) / static_cast<double>(size_ - 1);
  return newest(i).s - newest(i + 1).s > silent_steps * mean;
}

std::optional<double> RecentBounds::before_held() const {
  return since_held_ > 0 ? std::optional(before(since_held_ - 1)) : std::nullopt;
}

std::optional<OffsetBound> RecentBounds::release(double s) {
  if (since_held_ == 0 || newest(since_held_ - 1).s > s - windows_s.back()) return std::nullopt;
  const std::size_t first = since_held_ - 1;
  Entry& e = entries_[(next_ + capacity - 1 - first) % capacity];
  const bool was_held = e.standing == Standing::held;
  e.standing = Standing::usual;
  while (since_held_ > 0 && entry(since_held_ - 1).standing != Standing::held) --since_held_;
  return was_held ? std::optional(e.bound) : std::nullopt;
}

}  // namespace kinalign
