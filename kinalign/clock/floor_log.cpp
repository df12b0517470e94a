// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/floor_log.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double least_step_s = 0.7e-3;  // a thousandth of a second shows, with its noise
constexpr double sure_deviations = 5.0;
constexpr double alike_deviations = 4.0;
constexpr std::uint64_t enough_pairs = 4;

}  // namespace

void FloorLog::add(std::size_t side, OffsetBound bound, double slope) {
  const auto index = static_cast<std::int64_t>(std::floor(bound.s / window_s));
  if (index > index_) {
    close(side == 0 ? slope : -slope);
    index_ = index;
  } else if (index < index_) {
    return;  // reordered over the edge
  }
  const double middle = (static_cast<double>(index_) + 0.5) * window_s;
  const double x = bound.x + slope * (middle - bound.s);
  Lows& lows = now_[side];
  if (lows.count < lowest) {
    lows.x[lows.count++] = x;
  } else if (x < lows.x.back()) {
    lows.x.back() = x;
  } else {
    return;
  }
  std::sort(lows.x.begin(), lows.x.begin() + static_cast<std::ptrdiff_t>(lows.count));
}

void FloorLog::close(double slope) {
  std::rotate(past_.begin(), past_.end() - 1, past_.end());
  past_[0].reset();
  ++windows_;
  if (now_[0].count == lowest && now_[1].count == lowest) {
    const double up = now_[0].x.front(), down = now_[1].x.front();
    const auto gap = [](const Lows& l) { return (l.x.back() - l.x.front()) / (lowest - 1); };
    past_[0] = FloorWindow{(static_cast<double>(index_) + 0.5) * window_s, (up - down) / 2.0,
                           up + down, std::hypot(gap(now_[0]), gap(now_[1]))};
  }
  now_ = {};
  step_.reset();
  if (past_[0] && past_[2]) step_ = singles_.step(*past_[0], *past_[2], slope);
  const auto now = merged(0, 3, slope), then = merged(4, 3, slope);
  if (now && then && !step_) step_ = threes_.step(*now, *then, slope);
}

/// The lowest of floors over windows in a row, as of their middle one.
std::optional<FloorWindow> FloorLog::merged(std::size_t first, std::size_t count,
                                            double slope) const {
  const auto& centre = past_[first + count / 2];
  if (!centre) return std::nullopt;
  double up = centre->middle + centre->round_trip / 2.0;
  double down = centre->middle - centre->round_trip / 2.0;
  double gap = centre->gap;
  for (std::size_t i = first; i < first + count; ++i) {
    if (!past_[i]) return std::nullopt;
    const double moved = past_[i]->middle + slope * (centre->s - past_[i]->s);
    up = std::min(up, moved + past_[i]->round_trip / 2.0);
    down = std::max(down, moved - past_[i]->round_trip / 2.0);
    gap = std::max(gap, past_[i]->gap);
  }
  return FloorWindow{centre->s, (up + down) / 2.0, up - down, gap / static_cast<double>(count)};
}

std::optional<FloorWindow> FloorLog::window(std::size_t i) const {
  return i < past_.size() ? past_[i] : std::nullopt;
}

std::optional<double> FloorLog::Comparison::step(const FloorWindow& now, const FloorWindow& then,
                                                 double slope) {
  const double moved = now.middle - then.middle - slope * (now.s - then.s);
  const double longer = now.round_trip - then.round_trip;
  const double gap = std::hypot(now.gap, then.gap);
  const double usual =
      pairs >= enough_pairs ? std::sqrt(moved_squares / static_cast<double>(pairs)) : gap;
  // A step on its way through the windows is not usual.
  const double counted = pairs >= enough_pairs ? std::min(std::abs(moved), 2.0 * usual) : moved;
  ++pairs;
  moved_squares += counted * counted;
  const double least =
      std::max({least_step_s, sure_deviations * usual, sure_deviations * gap / 2.0});
  if (std::abs(moved) < least) return std::nullopt;
  return std::abs(longer) > alike_deviations * std::max(gap, usual) ? std::nullopt
                                                                    : std::optional(moved);
}

}  // namespace kinalign
