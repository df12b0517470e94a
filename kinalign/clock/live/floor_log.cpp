// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/floor_log.h"

#include "kinalign/clock/assumptions.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double least_step_s = 0.7e-3;  // a step of 1 ms is found, even with its noise
constexpr double sure_deviations = 5.0;
constexpr double alike_deviations = 4.0;
constexpr double slope_slack = 5e-6;
constexpr double agreeing_share = 0.05, agreeing_gaps = 3.0;
// The least width needs `alike` similar round trips; up to `most_too_short` shorter ones are
// ignored. With these values, one of 460 simulated recordings with valid assumptions wrongly showed
// a slip. In that recording a route became shorter than ever before.
constexpr std::size_t alike = 3, most_too_short = 2;
constexpr double wander_s = 20e-6;  // variation of real floors, caused by schedulers and caches
constexpr double narrow_share = 0.2, narrow_gaps = 2.0, narrow_spreads = 3.0;
constexpr std::uint64_t enough_pairs = 4;
constexpr double row_s = 1.5 * FloorLog::window_s;  // greatest distance of neighbouring windows

bool agree(double least, double most, double gap) {
  return most - least <= agreeing_share * least + agreeing_gaps * gap;
}

/// Returns the least possible width of an interval, s, for packets with this round trip.
double width(double round_trip, double gap, double spread) {
  const double noise = narrow_gaps * gap + narrow_spreads * spread;
  return round_trip - std::max({wander_s, narrow_share * round_trip, noise});
}

/// Returns the possible change of an offset, s, between windows that are unusually far apart. The
/// node sent nothing in between, and its crystal may have warmed.
double silence(double apart_s, double slope_deviation) {
  if (apart_s <= FloorLog::longest_reach_s) return 0.0;
  return Assumptions{}.curvature * apart_s * apart_s / 2.0 + 3.0 * slope_deviation * apart_s;
}

}  // namespace

// Inserts into a sorted array of fixed size. If the array is full, the longest round trip is
// dropped.
void ShortestRoundTrips::add(const FloorWindow& window) {
  if (window.round_trip <= 0.0) return;
  const auto end = shortest_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto place = std::find_if(shortest_.begin(), end,
                                  [&](const RoundTrip& r) { return window.round_trip < r.s; });
  if (place == shortest_.end()) return;
  std::move_backward(place, count_ < shortest_.size() ? end : end - 1,
                     count_ < shortest_.size() ? end + 1 : end);
  *place = {window.round_trip, window.gap};
  count_ = std::min(count_ + 1, shortest_.size());
}

void ShortestRoundTrips::leave(const FloorWindow& route) {
  const double known = width(route.round_trip, route.gap, 0.0);
  left_ = std::min(left_.value_or(known), known);
}

// Looks for the three shortest round trips that agree. Up to two shorter ones are ignored, because
// a counter may have stepped in their windows.
double ShortestRoundTrips::least_width() const {
  for (std::size_t i = 0; i <= most_too_short && i + alike <= count_; ++i) {
    double gap = 0.0;
    for (std::size_t k = i; k < i + alike; ++k) gap = std::max(gap, shortest_[k].gap);
    const double least = shortest_[i].s, most = shortest_[i + alike - 1].s;
    if (!agree(least, most, gap)) continue;
    return std::min(width(least, gap, most - least), left_.value_or(least));
  }
  return 0.0;
}

/// Stores the round trip of the previous route if its last two windows agree. One window alone may
/// be too short because of a step of the counter.
void FloorLog::change_route(double s) {
  const auto last = std::find_if(past_.begin(), past_.end(),
                                 [s](const auto& window) { return window && window->s <= s; });
  if (past_.end() - last < 2 || !last[1]) return;
  const auto& [shorter, longer] = std::minmax(
      *last[0], *last[1],
      [](const FloorWindow& a, const FloorWindow& b) { return a.round_trip < b.round_trip; });
  const double gap = std::max(shorter.gap, longer.gap);
  if (agree(shorter.round_trip, longer.round_trip, gap)) {
    shortest_.leave({shorter.s, shorter.middle, shorter.round_trip, gap});
  }
}

double FloorLog::least_width() const {
  const double least = shortest_.least_width();
  const auto is_short = [least](const auto& w) { return w && w->round_trip < least; };
  if (!past_[0]) return 0.0;
  return is_short(past_[0]) && !(is_short(past_[1]) && is_short(past_[2])) ? 0.0 : least;
}

void FloorLog::open(std::int64_t index, const SlopeBelief& slope) {
  index_ = index;
  slope_ = slope;
  now_ = {};
  corridor_ = Corridor(0.0, corners);
}

void FloorLog::add(const Bound& bound, const SlopeBelief& slope) {
  const auto index = static_cast<std::int64_t>(std::floor(bound.s / window_s));
  if (!index_ || index > *index_) {
    if (index_) close();
    open(index, slope);
  } else if (index < *index_) {
    return;  // a late packet of the previous window
  }
  const Bound level{bound.s, bound.x - slope_.mean * (bound.s - middle_s()), bound.side};
  corridor_.add(level);
  const double x = from_above(level).x;
  Lows& lows = now_[bound.side == Side::above ? 0 : 1];
  if (lows.count < lowest) {
    lows.x[lows.count++] = x;
  } else if (x < lows.x.back()) {
    lows.x.back() = x;
  } else {
    return;
  }
  std::sort(lows.x.begin(), lows.x.begin() + static_cast<std::ptrdiff_t>(lows.count));
}

/// Closes a window. Its floors are given by the widest line with about the expected slope. The
/// slope differs between windows if the rate of the clock changes.
void FloorLog::close() {
  std::rotate(past_.begin(), past_.end() - 1, past_.end());
  past_[0].reset();
  ++windows_;
  if (now_[0].count == lowest && now_[1].count == lowest) {
    const auto gap = [](const Lows& l) { return (l.x.back() - l.x.front()) / (lowest - 1); };
    // The slope of a new node is unknown, so all possible slopes are allowed.
    const bool known = slope_.deviation < SlopeBelief{}.deviation;
    const CorridorLine line =
        widest_line(corridor_, middle_s(), known ? slope_slack : greatest_rate);
    past_[0] = FloorWindow{middle_s(), line.middle(), line.width(),
                           std::hypot(gap(now_[0]), gap(now_[1]))};
    shortest_.add(*past_[0]);
  }
  step_.reset();
  const Expected expected{slope_, usual_round_trip()};
  if (past_[0] && past_[2]) step_ = singles_.step(*past_[0], *past_[2], expected);
  const auto now = merged(0, 3), then = merged(4, 3);
  if (now && then && !step_) step_ = threes_.step(*now, *then, expected);
}

/// Returns the median round trip of the stored windows; 0 if there is none.
double FloorLog::usual_round_trip() const {
  std::array<double, remembered> trips{};
  std::size_t count = 0;
  for (const auto& window : past_) {
    if (window) trips[count++] = window->round_trip;
  }
  const auto middle = trips.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(trips.begin(), middle, trips.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

/// Combines neighbouring windows: the lowest floors, converted to the middle window.
std::optional<FloorWindow> FloorLog::merged(std::size_t first, std::size_t count) const {
  const auto& centre = past_[first + count / 2];
  if (!centre) return std::nullopt;
  double up = centre->middle + centre->round_trip / 2.0;
  double down = centre->middle - centre->round_trip / 2.0;
  double gap = centre->gap;
  for (std::size_t i = first; i < first + count; ++i) {
    if (!past_[i] || std::abs(past_[i]->s - centre->s) > row_s) return std::nullopt;
    const double moved = past_[i]->middle + slope_.mean * (centre->s - past_[i]->s);
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
                                                 const Expected& expected) {
  const double moved = now.middle - then.middle - expected.slope.mean * (now.s - then.s);
  const double longer = now.round_trip - then.round_trip;
  const double gap = std::hypot(now.gap, then.gap);
  const double usual =
      pairs >= enough_pairs ? std::sqrt(moved_squares / static_cast<double>(pairs)) : gap;
  const double silent = silence(now.s - then.s, expected.slope.deviation);
  if (silent == 0.0) {
    // A step must not increase the usual difference while it passes through the windows.
    const double counted = pairs >= enough_pairs ? std::min(std::abs(moved), 2.0 * usual) : moved;
    ++pairs;
    moved_squares += counted * counted;
  }
  // A round trip may have become longer in one direction only. The middle then shifts by half of
  // the difference.
  const double unknown =
      std::max(0.0, (now.round_trip + then.round_trip) / 2.0 - expected.round_trip);
  const double least =
      unknown + silent +
      std::max({least_step_s, sure_deviations * usual, sure_deviations * gap / 2.0});
  if (std::abs(moved) < least) return std::nullopt;
  return std::abs(longer) > alike_deviations * std::max(gap, usual) ? std::nullopt
                                                                    : std::optional(moved);
}

}  // namespace kinalign
