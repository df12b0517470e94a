// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/offline_estimate.h"

#include "kinalign/clock/live/offset_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double bin_s = 10.0;
constexpr std::size_t lows_each = 12;
constexpr std::size_t bins_around = 5;  // windows on each side that give the density at a floor
constexpr int first_looks = 4;  // each pass improves the lines with which the next pass begins
constexpr std::size_t least_bounds = 20;  // bounds of each kind that a separate route needs
constexpr double same_crystal = 1e-6;     // possible difference between the slopes of two routes
constexpr double least_variance = 1e-14;

/// The changes of route, found by a pass through the bounds in their order, and the slope before
/// each change. The crystal is the same on all routes, so the slope is used as a prior.
struct Changes {
  std::vector<double> at;
  std::vector<SlopeBelief> slopes;  // on the routes before each change, and on the last route
};

/// Passes the bounds to the live estimate, which finds the changes of route.
Changes find_changes(const std::vector<Bound>& bounds) {
  OffsetEstimate estimate;
  Changes changes;
  SlopeBelief slope;
  for (const Bound& b : bounds) {
    estimate.add(b);
    if (estimate.changes() > changes.at.size()) {
      changes.at.push_back(estimate.last_change()->s);
      changes.slopes.push_back(slope);
    }
    slope = estimate.slope();
  }
  changes.slopes.push_back(slope);
  return changes;
}

std::size_t count(const std::vector<Bound>& bounds, Side side, double begin, double end) {
  return static_cast<std::size_t>(std::count_if(bounds.begin(), bounds.end(), [&](const Bound& b) {
    return b.side == side && b.s >= begin && b.s < end;
  }));
}

struct Span {
  double begin = 0.0, end = 0.0;
  double slope = 0.0;  // approximate
};

/// Returns the spans between changes of route. Short spans are omitted, because the route was
/// changing in them.
std::vector<Span> routes_between(const std::vector<Bound>& bounds, const Changes& changes) {
  double begin = bounds.front().s, end = begin;
  for (const Bound& b : bounds) {
    begin = std::min(begin, b.s);
    end = std::max(end, b.s);
  }
  const double first = begin;
  std::vector<Span> spans;
  for (std::size_t i = 0; i < changes.slopes.size(); ++i) {
    const double next = i < changes.at.size() ? changes.at[i] : std::nextafter(end, infinite);
    if (next <= begin) continue;
    const bool enough = count(bounds, Side::above, begin, next) >= least_bounds &&
                        count(bounds, Side::below, begin, next) >= least_bounds;
    if (enough) spans.push_back({begin, next, changes.slopes[i].mean});
    begin = next;
  }
  if (spans.empty()) spans.push_back({first, infinite, changes.slopes.back().mean});
  return spans;
}

/// Stores the lowest bounds, in rising order, after subtracting the slope.
void keep_low(std::vector<OffsetBound>& lows, OffsetBound bound, double slope) {
  const auto lower = [slope](const OffsetBound& a, const OffsetBound& b) {
    return a.x - slope * a.s < b.x - slope * b.s;
  };
  lows.insert(std::upper_bound(lows.begin(), lows.end(), bound, lower), bound);
  if (lows.size() > lows_each) lows.pop_back();
}

}  // namespace

// The routes are found first. Then each bound is added to its route, and the shifts that join the
// routes are computed. Bounds between two routes are not used.
OfflineEstimate::OfflineEstimate(const std::vector<Bound>& bounds) {
  const Changes changes = find_changes(bounds);
  const std::vector<Span> spans = routes_between(bounds, changes);
  for (const Span& span : spans) {
    const SlopeBelief prior =
        spans.size() == 1 ? SlopeBelief{} : SlopeBelief{span.slope, same_crystal};
    stretches_.push_back({span.begin, span.end, Route(prior, LiftedHull::all), {}, {}, 0.0});
  }
  for (const Bound& b : bounds) {
    const auto stretch = std::find_if(stretches_.begin(), stretches_.end(), [&](const Stretch& s) {
      return s.begin <= b.s && b.s < s.end;
    });
    if (stretch != stretches_.end()) add(*stretch, b, changes.slopes.back().mean);
  }
  for (Stretch& stretch : stretches_) {
    stretch.last = stretch.route.middle_elsewhere(stretch.begin, {});
    for (int look = 0; look < first_looks; ++look) stretch.last = middle(stretch, stretch.begin);
  }
  join();
}

void OfflineEstimate::add(Stretch& stretch, const Bound& b, double slope) {
  const auto bin = static_cast<std::size_t>(std::max(0.0, (b.s - stretch.begin) / bin_s));
  if (stretch.lows.size() <= bin) stretch.lows.resize(bin + 1);
  const OffsetBound bound = from_above(b);
  stretch.route.add(b.side, bound, stretch.last);
  const bool up = b.side == Side::above;
  Lows& lows = stretch.lows[bin];
  keep_low(up ? lows.above : lows.below, bound, up ? slope : -slope);
}

/// Returns the middle of one route at t. The lowest bounds around t show how well its floors are
/// known.
Middle OfflineEstimate::middle(const Stretch& stretch, double t) {
  Middle known = stretch.last;
  const auto bin = static_cast<std::size_t>(
      std::clamp((t - stretch.begin) / bin_s, 0.0, static_cast<double>(stretch.lows.size() - 1)));
  const FloorLine above = known.floor(Side::above), below = known.floor(Side::below);
  std::vector<double> over, under;
  const std::size_t first = bin - std::min(bin, bins_around);
  for (std::size_t i = first; i < std::min(bin + bins_around + 1, stretch.lows.size()); ++i) {
    for (const OffsetBound& b : stretch.lows[i].above) over.push_back(above.excess(b));
    for (const OffsetBound& b : stretch.lows[i].below) under.push_back(below.excess(b));
  }
  known.above_density = density_above(over);
  known.below_density = density_above(under);
  return stretch.route.middle_elsewhere(t, known);
}

/// Computes the shift of each route by least squares. Shifts should be small compared with the
/// round trip, and the offset should be continuous at changes of route. The equations are
/// tridiagonal.
void OfflineEstimate::join() {
  const std::size_t n = stretches_.size();
  if (n < 2) return;
  std::vector<double> own(n), jump(n - 1), weight(n - 1);
  const double least = least_round_trip();
  for (std::size_t i = 0; i < n; ++i) {
    const Middle& m = stretches_[i].last;
    const double longer = m.round_trip - least;
    const double variance = (longer * longer + std::pow(m.floor_deviation(), 2)) / 12.0;
    own[i] = 1.0 / (variance + least_variance);
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double s = (stretches_[i].end + stretches_[i + 1].begin) / 2.0;
    const Middle before = middle(stretches_[i], s);
    const Middle behind = middle(stretches_[i + 1], s);
    jump[i] = before.value - behind.value;
    weight[i] = 1.0 / (std::pow(before.deviation, 2) + std::pow(behind.deviation, 2));
  }
  std::vector<double> diagonal(n), right(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    diagonal[i] = own[i] + (i > 0 ? weight[i - 1] : 0.0) + (i + 1 < n ? weight[i] : 0.0);
    if (i > 0) right[i] += weight[i - 1] * jump[i - 1];
    if (i + 1 < n) right[i] -= weight[i] * jump[i];
  }
  for (std::size_t i = 1; i < n; ++i) {
    const double share = weight[i - 1] / diagonal[i - 1];
    diagonal[i] -= share * weight[i - 1];
    right[i] += share * right[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    const double next = i + 1 < n ? weight[i] * stretches_[i + 1].moved : 0.0;
    stretches_[i].moved = (right[i] + next) / diagonal[i];
  }
}

double OfflineEstimate::least_round_trip() const {
  double least = infinite;
  for (const Stretch& s : stretches_) least = std::min(least, s.last.round_trip);
  return least;
}

double OfflineEstimate::at(double t) {
  auto stretch = std::find_if(stretches_.begin(), stretches_.end() - 1,
                              [t](const Stretch& s) { return t < s.end; });
  // A time between two routes uses the nearer route.
  if (stretch != stretches_.begin() && stretch->begin - t > t - (stretch - 1)->end) --stretch;
  // The next call begins with this line, because neighbouring times have nearly the same line.
  stretch->last = middle(*stretch, t);
  return stretch->last.value + stretch->moved;
}

}  // namespace kinalign
