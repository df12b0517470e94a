// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/one_way_clock.h"

#include "kinalign/clock/bound.h"
#include "kinalign/clock/lifted_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace kinalign {

namespace {

constexpr double step_s = 1.0;
constexpr double rate_known = 5e-6;  // chosen: error of the rate of a piece of half a minute
// Chosen: on a busy radio link the delays vary by more than this. The least delay of three
// consecutive seconds does not.
constexpr double leap_s = 0.05;
constexpr std::size_t leap_seconds = 3, rate_seconds = 30;

/// Exchanges [begin, end) of one boot.
struct Stretch {
  std::size_t begin = 0, end = 0;
};

/// The least bound of each second (on the device's clock) that had an arrival.
struct Low {
  std::size_t first = 0;  // first exchange of that second
  std::int64_t second = 0;
  double s = 0.0, x = 0.0;
};

/// Computes the least bounds of a stretch, in seconds from its first exchange.
std::vector<Low> lows_of(std::span<const Exchange> exchanges, Stretch stretch) {
  const ClockOrigin origin{exchanges[stretch.begin].n_tx, exchanges[stretch.begin].h_rx};
  std::vector<Low> lows;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    const Bound b = bound_by(origin, Side::above, exchanges[i].n_tx, exchanges[i].h_rx);
    const auto second = static_cast<std::int64_t>(std::floor(b.s / step_s));
    if (lows.empty() || lows.back().second != second) lows.push_back({i, second, b.s, b.x});
    if (b.x < lows.back().x) {
      lows.back().s = b.s;
      lows.back().x = b.x;
    }
  }
  return lows;
}

/// Returns the lowest of three seconds. In a single second all packets may have been delayed.
const Low& level_at(const std::vector<Low>& lows, std::size_t from) {
  const auto begin = lows.begin() + static_cast<std::ptrdiff_t>(from);
  return *std::min_element(begin, begin + leap_seconds,
                           [](const Low& a, const Low& b) { return a.x < b.x; });
}

/// Returns whether the offset jumps at second k: the three seconds from k on differ from the
/// seconds before by more than leap_s, all in the same direction. The expected offset follows the
/// rate of the half minute before. Delays can raise the bound of a single second, but not of three.
bool leaps(const std::vector<Low>& lows, std::size_t first, std::size_t k) {
  if (k < first + leap_seconds || k + leap_seconds > lows.size()) return false;
  const Low& before = level_at(lows, k - leap_seconds);
  const Low& early = level_at(lows, std::max(first + rate_seconds, k) - rate_seconds);
  const bool apart = before.s - early.s > rate_seconds / 2.0;
  const double rate = apart ? (before.x - early.x) / (before.s - early.s) : 0.0;
  std::size_t above = 0, below = 0;
  for (std::size_t i = k; i < k + leap_seconds; ++i) {
    const double moved = lows[i].x - before.x - rate * (lows[i].s - before.s);
    above += moved > leap_s ? 1 : 0;
    below += moved < -leap_s ? 1 : 0;
  }
  return above == leap_seconds || below == leap_seconds;
}

/// Returns the exchange of the jump within its second: the one with the greatest change from its
/// predecessor.
std::size_t place_of_leap(std::span<const Exchange> exchanges, const Low& before, const Low& behind,
                          std::size_t end) {
  const auto level = [&](std::size_t i) {
    return exchanges[i].h_rx.time_since_epoch() - exchanges[i].n_tx.time_since_epoch();
  };
  std::size_t place = behind.first;
  Duration greatest{0};
  for (std::size_t i = before.first + 1; i < end; ++i) {
    const Duration change = level(i) - level(i - 1);
    const Duration size = change < Duration{0} ? -change : change;
    if (size > greatest) {
      greatest = size;
      place = i;
    }
  }
  return place;
}

/// Splits the exchanges of one boot at jumps.
std::vector<Stretch> even_stretches(std::span<const Exchange> exchanges, Stretch boot) {
  std::vector<Stretch> out;
  const std::vector<Low> lows = lows_of(exchanges, boot);
  std::size_t begin = boot.begin, first = 0;
  for (std::size_t k = 1; k < lows.size(); ++k) {
    if (!leaps(lows, first, k)) continue;
    const std::size_t end = k + 1 < lows.size() ? lows[k + 1].first : boot.end;
    const std::size_t place = place_of_leap(exchanges, lows[k - 1], lows[k], end);
    if (place <= begin) continue;
    out.push_back({begin, place});
    begin = place;
    first = k;
  }
  out.push_back({begin, boot.end});
  return out;
}

/// Returns the times of the knots: each second with an arrival, and its neighbours. A straight line
/// covers a pause, which has no samples.
std::vector<double> knots_of(std::span<const Exchange> exchanges, const ClockOrigin& origin,
                             double begin, double end) {
  std::vector<std::int64_t> seconds;
  for (const Exchange& e : exchanges) {
    const double s = bound_by(origin, Side::above, e.n_tx, e.h_rx).s;
    const auto second = static_cast<std::int64_t>(std::floor((s - begin) / step_s));
    if (!seconds.empty() && seconds.back() == second + 1) continue;
    seconds.insert(seconds.end(), {second, second + 1});
  }
  std::sort(seconds.begin(), seconds.end());
  seconds.erase(std::unique(seconds.begin(), seconds.end()), seconds.end());
  std::vector<double> knots;
  knots.reserve(seconds.size());
  for (const std::int64_t k : seconds) {
    const double s = begin + step_s * static_cast<double>(k);
    if (s < end) knots.push_back(s);
  }
  if (knots.empty() || end > knots.back()) knots.push_back(end);  // another piece may begin there
  return knots;
}

// There are only upper bounds. The offset is therefore the greatest function that the bounds and
// the curvature allow. All packets may be late by the same least delay, which arrivals can't show.
ClockPieceModel fit(std::span<const Exchange> exchanges, Stretch stretch, double curvature) {
  const Exchange& front = exchanges[stretch.begin];
  const ClockOrigin origin{front.n_tx, front.h_rx};
  ClockPieceModel model;
  model.boot = front.boot;
  model.first = model.last = front.h_rx;
  LiftedHull hull(curvature), straight(0.0);
  double begin = 0.0, end = 0.0;
  for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
    const Bound b = bound_by(origin, Side::above, exchanges[i].n_tx, exchanges[i].h_rx);
    hull.add(b.s, b.x);
    straight.add(b.s, b.x);
    begin = std::min(begin, b.s);
    end = std::max(end, b.s);
    model.first = std::min(model.first, exchanges[i].h_rx);
    model.last = std::max(model.last, exchanges[i].h_rx);
  }
  // There are no lower bounds, so `certified` stays false.
  model.up = stretch.end - stretch.begin;
  // The edge of the hull at the middle of the piece gives the rate. A corner near an end of the
  // piece may be any packet that arrived there. The offset may deviate from the rate only as far as
  // the rate may have changed.
  const double middle = straight.peak((begin + end) / 2.0).slope;
  const double rate = std::isfinite(middle) ? middle : 0.0;
  const double change = rate_known + curvature * (end - begin) / 2.0;
  const Duration base = origin.host.time_since_epoch() - origin.node.time_since_epoch();
  for (const double s : knots_of(exchanges.subspan(stretch.begin, stretch.end - stretch.begin),
                                 origin, begin, end)) {
    const Duration since = nanoseconds(std::round(s * 1e9));
    const double t = seconds(since);
    const double slope = std::clamp(hull.peak(t).slope, rate - change, rate + change);
    const Duration offset = base + nanoseconds(std::round(hull.at(t, slope).bound * 1e9));
    model.knots.push_back({origin.node + since, offset, offset, offset});
  }
  return model;
}

}  // namespace

HostFromNode fit_one_way_clock(std::span<const Exchange> exchanges, double curvature) {
  HostFromNode out;
  for (std::size_t begin = 0; begin < exchanges.size();) {
    const auto rest = exchanges.subspan(begin);
    const auto other = std::find_if(rest.begin(), rest.end(),
                                    [&](const Exchange& e) { return e.boot != rest.front().boot; });
    const std::size_t end = begin + static_cast<std::size_t>(other - rest.begin());
    for (const Stretch& stretch : even_stretches(exchanges, {begin, end})) {
      out.pieces.push_back(fit(exchanges, stretch, curvature));
    }
    begin = end;
  }
  return out;
}

}  // namespace kinalign
