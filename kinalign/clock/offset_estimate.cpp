// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offset_estimate.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double settling_s = 8.0;  // before a route's floors are known
constexpr std::uint64_t settling_points = 100;
constexpr double gaps_off = 20.0;         // a floor's usual gaps that make a bound stand apart, …
constexpr double least_off_s = 20e-6;     // … and at least this
constexpr double wander = 0.2e-6;         // of a slope between two routes
constexpr double alike_deviations = 8.0;  // of round trips before and behind a step
constexpr double step_deviations = 20.0;
constexpr std::uint32_t often = 64, seldom = 4;

}  // namespace

FloorLine OffsetEstimate::line(Side side) const {
  return side == Side::above ? middle_.above() : middle_.below();
}

const Floor& OffsetEstimate::floor(Side side) const {
  return side == Side::above ? route_.above() : route_.below();
}

bool OffsetEstimate::settled(double s) const {
  return since_ && s - *since_ > settling_s && middle_.floor_deviation() < 1.0;
}

void OffsetEstimate::add_to_route(Side side, OffsetBound bound) {
  if (!since_) since_ = bound.s;
  if (side == Side::above) {
    route_.add_above(bound, middle_);
  } else {
    route_.add_below(bound, middle_);
  }
}

void OffsetEstimate::add(Side side, OffsetBound bound) {
  RecentBounds& recent = recent_[static_cast<std::size_t>(side)];
  const double density = side == Side::above ? middle_.above_density : middle_.below_density;
  const bool watched = settled(bound.s) && floor(side).counts().total() >= settling_points;
  const double limit = watched ? std::max(gaps_off / density, least_off_s) : 0.0;
  const double excess = watched ? line(side).excess(bound) : 0.0;
  const Standing standing = excess < -limit  ? Standing::held
                            : excess > limit ? Standing::above
                                             : Standing::usual;
  recent.add(bound, standing);
  if (standing != Standing::held) add_to_route(side, bound);
  if (const auto late = recent.release(bound.s)) add_to_route(side, *late);
  if (watched) {
    judge_change();
    if (const auto s = recent.moved(line(side), floor(side).counts())) return change_route(*s);
  }
  const auto points = route_.above().counts().total() + route_.below().counts().total();
  if (route_.bounded() && ++unseen_ >= (points < often ? 1 : seldom)) refresh(bound.s);
}

void OffsetEstimate::refresh(double t) {
  middle_ = route_.middle(t, middle_);
  unseen_ = 0;
}

/// The route's middle, moved by what the joint says against what its own round trip allows: extra
/// delays of a route are as likely to be all up as all down or any share between.
Middle OffsetEstimate::joined(const Middle& middle) const {
  if (!joint_) return middle;
  const Middle there = route_.middle_elsewhere(joint_->s, middle);
  const double carried = joint_->x - there.value;
  const double carried_variance = joint_->variance + there.deviation * there.deviation;
  const double longer = std::max(0.0, middle.round_trip - least_round_trip_);
  const double own_variance = (longer * longer + std::pow(middle.floor_deviation(), 2)) / 12.0;
  const double share = own_variance / (own_variance + carried_variance);
  Middle moved = middle;
  moved.value += share * carried;
  moved.deviation = std::sqrt(middle.deviation * middle.deviation + share * carried_variance);
  return moved;
}

std::optional<Middle> OffsetEstimate::at(double t) {
  if (route_.bounded()) {
    refresh(t);
    return joined(middle_);
  }
  if (!joint_) return std::nullopt;
  Middle middle = middle_;
  middle.t = t;
  middle.value = joint_->x + middle_.slope * (t - joint_->s);
  middle.deviation = std::sqrt(joint_->variance);
  return middle;
}

/// Asked once the floors of the present route are known.
void OffsetEstimate::judge_change() {
  if (!joint_ || joint_->judged) return;
  joint_->judged = true;
  const double noise = std::hypot(joint_->floor_deviation, middle_.floor_deviation());
  if (std::abs(middle_.round_trip - joint_->round_trip) > alike_deviations * noise) return;
  const double step = route_.middle_elsewhere(joint_->s, middle_).value - joint_->x;
  if (std::abs(step) < step_deviations * noise) return;
  last_change_->step = step;
  joint_->x += step;
  joint_->variance += step * step;
}

double OffsetEstimate::least_round_trip() const {
  return joint_ ? std::min(least_round_trip_, middle_.round_trip) : middle_.round_trip;
}

/// What came after s is of a new route.
void OffsetEstimate::change_route(double s) {
  for (const RecentBounds& recent : recent_) s = std::min(s, recent.before_held().value_or(s));
  const Middle old = *at(s);
  const bool silent = recent_[0].silent_around(s);
  least_round_trip_ = joint_ ? std::min(least_round_trip_, old.round_trip) : old.round_trip;
  joint_ = Joint{
      s, old.value, old.deviation * old.deviation, old.round_trip, old.floor_deviation(), silent};
  const Middle before = middle_;
  route_ = Route({old.slope, route_.belief().deviation + wander});
  since_.reset();
  unseen_ = 0;
  ++changes_;
  std::array<double, 2> risen{};
  const std::array sides{Side::above, Side::below};
  for (std::size_t i = 0; i < 2; ++i) {
    const FloorLine floor = sides[i] == Side::above ? before.above() : before.below();
    bool any = false;
    for (std::size_t k = 0; k < recent_[i].size() && recent_[i].newest(k).s > s; ++k) {
      const double excess = floor.excess(recent_[i].newest(k));
      risen[i] = any ? std::min(risen[i], excess) : excess;
      any = true;
    }
  }
  last_change_ = RouteChange{s, std::nullopt};
  // The first guess at the new floors: through the lowest points.
  middle_.t = s;
  middle_.value = before.at(s) + (risen[0] - risen[1]) / 2.0;
  middle_.slope = old.slope;
  middle_.round_trip = before.round_trip + risen[0] + risen[1];
  middle_.above_density = middle_.below_density = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    std::size_t k = 0;
    while (k < recent_[i].size() && recent_[i].newest(k).s > s) ++k;
    RecentBounds kept;
    while (k-- > 0) {
      kept.add(recent_[i].newest(k), Standing::usual);
      add_to_route(sides[i], recent_[i].newest(k));
    }
    recent_[i] = kept;
  }
}

}  // namespace kinalign
