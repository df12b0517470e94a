// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/clock_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinalign {

namespace {

// Share of the round trip. A step of this size stays within the certificate, since half of the
// round trip is the least delay.
constexpr double harmless_share = 0.4;
constexpr Duration before_a_slip = Violators::wait;
// Lifted coordinates (lifted_hull.h) of a clock with a crystal's curvature. Doubles are exact to 11
// ns over a year and to 1 us over three years.
constexpr double longest_piece_s = 1e8;
constexpr Duration oldest_reading = std::chrono::seconds(10);
constexpr int looked_back = 12;  // number of windows
/// The range of x is computed again after stale_s seconds or after `seldom` bounds.
constexpr double stale_s = 0.5;
constexpr std::uint32_t seldom = 4;

Duration rounded_down(double s) { return Duration{static_cast<std::int64_t>(std::floor(s * 1e9))}; }
Duration rounded_up(double s) { return Duration{static_cast<std::int64_t>(std::ceil(s * 1e9))}; }

}  // namespace

Bound ClockPiece::bound(const Crossing& crossing) const {
  return bound_by(origin_, crossing.side, crossing.n, crossing.h);
}

HostTime ClockPiece::host_time(const Bound& e) const {
  return origin_.host + rounded_down(e.s + e.x);
}

void ClockPiece::ask(double s) {
  range_ = certificate_.at(s);
  range_at_ = s;
  unseen_ = 0;
}

/// Returns how far a bound lies beyond the range of the certificate, s; 0 or less: inside. The last
/// computed range is used, widened by the time since then, unless later bounds would narrow it.
double ClockPiece::violation(const Bound& e) {
  if (!certificate_.bounded()) return 0.0;
  if (!range_ || e.s - range_at_ > stale_s || unseen_ >= seldom) ask(e.s);
  if (!range_) {
    contradicted_ = true;
    return 0.0;
  }
  const double d = e.s - range_at_;
  const double bent = assumptions().curvature * d * d / 2.0;
  const double low =
      range_->low + std::min(range_->least_slope * d, range_->greatest_slope * d) - bent;
  const double high =
      range_->high + std::max(range_->least_slope * d, range_->greatest_slope * d) + bent;
  unseen_ += (e.side == Side::above ? e.x < high : e.x > low) ? 1 : 0;
  return e.side == Side::above ? low - e.x : e.x - high;
}

// The floors need the slope without this bound. They must know of a change of route before the
// bound is added.
void ClockPiece::add(const Bound& b) {
  const SlopeBelief slope = estimate_.slope();
  const std::uint32_t changes = estimate_.changes();
  certificate_.add(b);
  estimate_.add(b);
  if (estimate_.changes() != changes) floors_.change_route(estimate_.last_change()->s);
  floors_.add(b, slope);
  journal_.add(b);
}

// A bound outside the certificate is stored as a violator. The piece ends if bounds contradict each
// other, or if a violator is not refuted in time. Any other bound is added and may show a small
// step.
ClockPiece::Verdict ClockPiece::push(const Crossing& crossing) {
  const Bound e = bound(crossing);
  newest_arrival_ = crossing.arrival;
  ++crossings_;
  if (std::abs(e.s) > longest_piece_s || std::abs(e.x) > longest_piece_s) {
    amount_ = std::abs(e.x);
    return Verdict::violator;  // no counter that has just started gives such a reading
  }
  amount_ = violation(e);
  if (amount_ > Violators::tolerated_s) {
    violators_.add({crossing, e, amount_, crossings_});
    return violators_.full() ? broken(End::violators) : Verdict::violator;
  }
  if (contradicted_) {
    amount_ = 0.0;  // the wrong bounds are not known
    return broken(End::contradiction);
  }
  violators_.drop_excluded_by(e, assumptions().rate);
  if (violators_.overdue(newest_arrival_, crossings_)) {
    amount_ = violators_.pending().front().amount;
    return broken(End::overdue_violator);
  }
  add(e);
  return slipped().value_or(Verdict::taken);
}

ClockPiece::Verdict ClockPiece::broken(End why) {
  end_ = why;
  return Verdict::broken;
}

/// Looks for a step smaller than the least delay. The true offset is then still within the
/// certificate.
std::optional<ClockPiece::Verdict> ClockPiece::slipped() {
  if (floors_.windows() == windows_judged_ && estimate_.changes() == routes_judged_) return {};
  if (const auto by = narrowed()) {
    amount_ = *by;
    end_ = End::narrowed;
    return Verdict::slipped;
  }
  const auto with_route = stepped_with_route(), between_windows = stepped_between_windows();
  if (!with_route && !between_windows) return std::nullopt;
  amount_ = with_route ? *with_route : *between_windows;
  if (std::abs(amount_) < harmless_share * estimate_.least_round_trip()) return Verdict::uneasy;
  end_ = with_route ? End::slip_with_route : End::slip_between_windows;
  return Verdict::slipped;
}

/// Returns by how much the interval is narrower than the shortest possible round trip. This happens
/// if bounds from before and after a slip are combined. The effect depends on the time of the slip,
/// so several windows are checked. Computed once per window.
std::optional<double> ClockPiece::narrowed() {
  if (floors_.windows() == windows_judged_ || !certificate_.bounded()) return std::nullopt;
  const double least = floors_.least_width(), now = journal_.newest(0).s;
  double left = std::numeric_limits<double>::infinity();
  for (int window = 0; window < looked_back; ++window) {
    const double back = (window + 0.5) * FloorLog::window_s;
    const auto range = certificate_.at(std::max(now - back, 0.0));
    if (!range) {
      contradicted_ = true;  // worse than a slip; reported with the next bound
      return std::nullopt;
    }
    left = std::min(left, range->high - range->low);
  }
  return left < least ? std::optional(least - left) : std::nullopt;
}

/// Returns the step of the counter at the newest change of route. Each change is reported once.
std::optional<double> ClockPiece::stepped_with_route() {
  const auto& change = estimate_.last_change();
  if (!change || !change->step || estimate_.changes() == routes_judged_) return std::nullopt;
  routes_judged_ = estimate_.changes();
  return change->step;
}

/// Returns the step between windows, computed once per window. If the route changed recently,
/// windows before and after the change can't be compared.
std::optional<double> ClockPiece::stepped_between_windows() {
  if (floors_.windows() == windows_judged_) return std::nullopt;
  windows_judged_ = floors_.windows();
  const auto& change = estimate_.last_change();
  const bool one_route =
      !change || journal_.newest(0).s - change->s > FloorLog::longest_reach_s + FloorLog::window_s;
  return one_route ? floors_.step() : std::nullopt;
}

std::optional<HostTime> ClockPiece::step_pending_since() const {
  if (violators_.pending().empty()) return std::nullopt;
  return std::max(begin_, doubt_of_violators());
}

/// Returns the arrival of the last crossing that contradicts one of the violators. At that time the
/// counter had not stepped. The result is at least five seconds before the first violator.
HostTime ClockPiece::doubt_of_violators() const {
  HostTime since = violators_.pending()[0].crossing.arrival - Violators::wait;
  for (std::size_t i = 0; i < journal_.size(); ++i) {
    const Bound e = journal_.newest(i);
    for (const Violator& v : violators_.pending()) {
      if (contradict(e, v.bound, assumptions().rate)) return std::min(host_time(e), since);
    }
  }
  return begin_;
}

HostTime ClockPiece::doubtful_since() const {
  HostTime since = begin_;
  if (end_ == End::violators || end_ == End::overdue_violator) since = doubt_of_violators();
  if (end_ == End::slip_with_route) since = about(estimate_.last_change()->s) - before_a_slip;
  if (end_ == End::slip_between_windows)
    since = newest_arrival_ - rounded_up(FloorLog::longest_reach_s);
  return std::max(since, begin_);
}

HostTime ClockPiece::next_begins() const {
  return end_ == End::violators ? violators_.pending()[0].crossing.arrival : newest_arrival_;
}

/// Returns the approximate host time at s, ignoring delays.
HostTime ClockPiece::about(double s) const {
  std::size_t i = 0;
  while (i + 1 < journal_.size() && journal_.newest(i).s > s) ++i;
  return host_time({s, journal_.newest(i).x});
}

/// Returns whether all bounds also fit a counter without a step whose rate changes as fast as a
/// crystal's rate can change. The two cases can't be distinguished then, so the next piece allows
/// for both.
bool ClockPiece::may_bend() const {
  Certificate bent = certificate_.relaxed(most_curvature);
  for (const Violator& v : violators_.pending()) bent.add(v.bound);
  return bent.at(journal_.newest(0).s).has_value();
}

/// Returns the piece after a small step. The exact time of the step is unknown, so its certificate
/// contains no earlier bounds. The estimate already began anew with the change of route, or it
/// begins with the last window.
ClockPiece ClockPiece::next_after_slip(const Assumptions& assumed, const SlopeBelief& prior) const {
  ClockPiece next = *this;
  next.begin_ = newest_arrival_;
  next.end_ = End::none;
  next.certificate_ = Certificate(assumed, corners);
  next.range_.reset();
  next.contradicted_ = false;
  next.violators_.clear();
  next.floors_ = FloorLog(floors_.shortest());
  next.windows_judged_ = 0;
  if (end_ == End::slip_with_route) return next;
  next.estimate_ = OffsetEstimate(prior);
  next.routes_judged_ = 0;
  const double now = journal_.newest(0).s;
  for (std::size_t i = journal_.size(); i-- > 0;) {
    const Bound b = journal_.newest(i);
    if (b.s > now - FloorLog::window_s) next.estimate_.add(b);
  }
  return next;
}

/// Returns the greatest possible backward step of the counter: the distance to the certificate plus
/// the width of the interval.
Duration ClockPiece::greatest_step_back() const {
  if (end_ == End::none) return Duration{0};
  const auto violators = violators_.pending();
  // In this case the counter stepped ahead, not back.
  if (!violators.empty() && violators[0].bound.side == Side::above) return Duration{0};
  const auto range = certificate_.at(journal_.newest(0).s);
  const double width = range ? range->high - range->low : 2.0 * estimate_.least_round_trip();
  return rounded_up(std::min(std::abs(amount_) + width, seconds(oldest_reading)));
}

/// Returns the piece after a break. It begins with the violators if they caused the break,
/// otherwise with the newest bound.
ClockPiece ClockPiece::next_behind(const Assumptions& assumed, const SlopeBelief& prior) const {
  if (end_ == End::slip_with_route || end_ == End::slip_between_windows) {
    return next_after_slip(assumed, prior);
  }
  if (end_ == End::violators) {
    const Crossing& first = violators_.pending()[0].crossing;
    ClockPiece next({first.n, first.h}, assumed, prior, floors_.shortest());
    for (const Violator& v : violators_.pending()) next.add(next.bound(v.crossing));
    next.begin_ = next.newest_arrival_ = next_begins();
    return next;
  }
  const Bound last = journal_.newest(0);
  ClockPiece next({origin_.node + rounded_down(last.s), host_time(last)}, assumed, prior,
                  floors_.shortest());
  next.begin_ = next.newest_arrival_ = newest_arrival_;
  return next;
}

/// A counter that stepped ahead shows no reading twice. The new piece gives older readings times
/// before the step. A counter that stepped back shows some readings twice.
ClockPiece ClockPiece::next_piece() const {
  Assumptions assumed = assumptions();
  if (end_ != End::none && may_bend()) assumed.curvature = most_curvature;
  ClockPiece next = next_behind(assumed, estimate_.slope().after_a_break());
  // Readings from before a backward step must not be certified in the new piece.
  next.certified_from_ = std::max(certified_from_, newest_arrival_ + greatest_step_back());
  return next;
}

std::optional<ClockStamp> ClockPiece::at(NodeTime n) {
  const double s = seconds(n - origin_.node);
  if (std::abs(s) > longest_piece_s) return std::nullopt;
  const auto middle = estimate_.at(s);
  if (!middle) return std::nullopt;
  ClockStamp stamp;
  stamp.assumptions = assumptions();
  double x = middle->value;
  ask(s);
  if (const auto& range = range_) {
    // The likeliest offset may be outside the possible range, for example if a route was guessed
    // wrongly.
    x = std::clamp(x, range->low, range->high);
    stamp.earliest = origin_.host + rounded_down(s + range->low);
    stamp.latest = origin_.host + rounded_up(s + range->high + counter_resolution_s);
    if (certificate_.bounded()) {
      const bool stands = violators_.pending().empty() &&
                          is_behind_step(*stamp.earliest, certified_from_, newest_arrival_);
      stamp.certainty = stands ? Certainty::certified : Certainty::doubtful;
    }
  } else {
    stamp.certainty = Certainty::doubtful;
  }
  stamp.time = origin_.host + Duration{std::llround((s + x + counter_resolution_s / 2.0) * 1e9)};
  return stamp;
}

}  // namespace kinalign
