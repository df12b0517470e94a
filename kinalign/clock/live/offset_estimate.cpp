// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/offset_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

constexpr double floors_known_after_s = 8.0;  // time after which the floors of a route are known
constexpr std::uint64_t floors_known_from_points = 100;
// A bound may belong to another route if its distance from the floor exceeds the usual gaps by this
// factor.
constexpr double gaps_off = 20.0;
constexpr double least_off_s = 20e-6;  // smallest such distance
constexpr double wander = 0.2e-6;      // possible difference between the slopes on two routes
// Tolerance for the round trips before and after a step, in units of their noise.
constexpr double alike_round_trips = 8.0;
constexpr double step_deviations = 20.0;
// While a route has fewer points, its middle is computed after each bound.
constexpr std::uint64_t few_points = 64;
// A bound this many gaps above the floor tells almost nothing about the floor (weight e^-8).
constexpr double far_gaps = 8.0;
constexpr std::uint32_t most_unseen = 4;
constexpr double stale_middle_s = 1.0, stale_answer_s = 0.25;
constexpr double no_limit = std::numeric_limits<double>::infinity();

}  // namespace

bool OffsetEstimate::floors_known(double s) const {
  return since_ && s - *since_ > floors_known_after_s && middle_.sharp();
}

void OffsetEstimate::add_to_route(Side side, OffsetBound bound) {
  if (!since_) since_ = bound.s;
  route_.add(side, bound, middle_);
}

/// Adds a bound to the route, unless it is so far from the floor that it may belong to another
/// route.
void OffsetEstimate::add(const Bound& b) {
  const OffsetBound bound = from_above(b);
  RecentBounds& recent = this->recent(b.side);
  const FloorLine line = middle_.floor(b.side);
  const double density = middle_.density(b.side), excess = line.excess(bound);
  const ExcessCounts& counts = route_.floor(b.side).counts();
  const bool watched = floors_known(b.s) && counts.total() >= floors_known_from_points;
  double limit = no_limit;
  if (watched) limit = std::max(gaps_off / density, least_off_s);
  const Standing standing = excess < -limit  ? Standing::held
                            : excess > limit ? Standing::above
                                             : Standing::usual;
  recent.add(bound, standing);
  if (standing != Standing::held) add_to_route(b.side, bound);
  if (const auto late = recent.release(b.s)) add_to_route(b.side, *late);
  if (watched) {
    judge_change(b.s);
    if (const auto s = recent.moved(line, counts)) return change_route(*s);
  }
  look(b.s, !(excess * density > far_gaps));
}

/// Computes the middle again after enough informative bounds. `is_informative`: whether this bound
/// is informative.
void OffsetEstimate::look(double s, bool is_informative) {
  if (!route_.bounded()) return;
  const bool young = route_.points() < few_points;
  if (is_informative || young) ++unseen_;
  if (unseen_ >= (young ? 1 : most_unseen) || s - middle_.t > stale_middle_s) refresh(s);
}

void OffsetEstimate::refresh(double t) {
  middle_ = route_.middle(t, middle_);
  unseen_ = 0;
}

/// Combines the middle of the present route with the value carried over from earlier routes,
/// weighted by their variances. The additional delay of a route may occur in either direction or be
/// divided between both. All divisions are assumed equally likely.
Middle OffsetEstimate::joined(const Middle& middle) const {
  if (!joint_) return middle;
  const Middle there = route_.middle_elsewhere(joint_->s, middle);
  const double carried = joint_->x - there.value;
  const double carried_variance = joint_->variance + there.deviation * there.deviation;
  const double longer = std::max(0.0, middle.round_trip - least_round_trip_);
  // A value that is equally likely in a whole range has the variance range^2 / 12.
  const double own_variance = (longer * longer + std::pow(middle.floor_deviation(), 2)) / 12.0;
  const double share = own_variance / (own_variance + carried_variance);
  Middle moved = middle;
  moved.value += share * carried;
  moved.deviation = std::sqrt(middle.deviation * middle.deviation + share * carried_variance);
  return moved;
}

/// If the present route has only bounds of one kind, the offset is extrapolated from the earlier
/// route.
std::optional<Middle> OffsetEstimate::at(double t) {
  if (route_.bounded()) {
    if (unseen_ > 0 || std::abs(t - middle_.t) > stale_answer_s) refresh(t);
    return joined(middle_.moved_to(t));
  }
  if (!joint_) return std::nullopt;
  Middle middle = middle_;
  middle.t = t;
  middle.value = joint_->x + middle_.slope * (t - joint_->s);
  middle.deviation = std::sqrt(joint_->variance);
  return middle;
}

/// Decides whether the counter stepped at the change of route. Called when the floors of the
/// present route are known.
void OffsetEstimate::judge_change(double s) {
  if (!joint_ || joint_->judged) return;
  refresh(s);
  joint_->judged = true;
  const double noise = std::hypot(joint_->floor_deviation, middle_.floor_deviation());
  if (std::abs(middle_.round_trip - joint_->round_trip) > alike_round_trips * noise) return;
  const double step = route_.middle_elsewhere(joint_->s, middle_).value - joint_->x;
  if (std::abs(step) < step_deviations * noise) return;
  last_change_->step = step;
  joint_->x += step;
  joint_->variance += step * step;
}

double OffsetEstimate::least_round_trip() const {
  return joint_ ? std::min(least_round_trip_, middle_.round_trip) : middle_.round_trip;
}

/// Carries the offset at s over to a new route.
void OffsetEstimate::join_routes(double s) {
  const Middle old = *at(s);
  least_round_trip_ = joint_ ? std::min(least_round_trip_, old.round_trip) : old.round_trip;
  const double variance = old.deviation * old.deviation;
  const bool silent = recent(Side::above).silent_around(s);
  joint_ = Joint{s, old.value, variance, old.round_trip, old.floor_deviation(), silent};
  route_ = Route({old.slope, route_.belief().deviation + wander});
}

/// Makes a first guess of the new floors from the lowest points after s.
void OffsetEstimate::guess_floors(double s, const Middle& before) {
  const auto risen = [&](Side side) {
    const FloorLine floor = before.floor(side);
    double least = no_limit;
    for (std::size_t k = 0; k < recent(side).behind(s); ++k) {
      least = std::min(least, floor.excess(recent(side).newest(k)));
    }
    return least < no_limit ? least : 0.0;
  };
  const double up = risen(Side::above), down = risen(Side::below);
  middle_ = before.moved_to(s);
  middle_.value += (up - down) / 2.0;
  middle_.round_trip += up + down;
  middle_.above_density = middle_.below_density = 0.0;
}

/// Begins a new route with the bounds after s.
void OffsetEstimate::change_route(double s) {
  for (const RecentBounds& recent : recent_) s = std::min(s, recent.before_held().value_or(s));
  join_routes(s);
  since_.reset();
  unseen_ = 0;
  ++changes_;
  last_change_ = RouteChange{s, std::nullopt};
  guess_floors(s, middle_);
  for (const Side side : {Side::above, Side::below}) {
    RecentBounds kept;
    for (std::size_t k = recent(side).behind(s); k-- > 0;) {
      const OffsetBound& bound = recent(side).newest(k);
      kept.add(bound, Standing::usual);
      add_to_route(side, bound);
    }
    recent(side) = kept;
  }
}

}  // namespace kinalign
