// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/clock_piece.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double tolerated_s = 5e-6;  // against the certificate, before a bound is a violator
constexpr Duration violators_within = std::chrono::seconds(5);
constexpr double harmless_share = 0.4;      // of the round trip: half of it is the least delay
constexpr std::uint64_t few_crossings = 8;  // of a node that says little
constexpr Duration before_a_slip = std::chrono::seconds(5);
constexpr Duration longest_reach = std::chrono::seconds(70);
constexpr double longest_piece_s = 1e8;  // three years; lifted, doubles keep 30 ns over that
constexpr double stale_s = 0.5;
constexpr double between_pieces = 2e-6;  // by which a slope may differ
constexpr std::uint32_t seldom = 4;

Duration rounded_down(double s) { return Duration{static_cast<std::int64_t>(std::floor(s * 1e9))}; }
Duration rounded_up(double s) { return Duration{static_cast<std::int64_t>(std::ceil(s * 1e9))}; }

/// Whether two bounds of different kinds leave no way for a function of at most this rate.
bool contradict(const Bound& a, const Bound& b, double rate) {
  if (a.side == b.side) return false;
  const Bound& above = a.side == Side::above ? a : b;
  const Bound& below = a.side == Side::above ? b : a;
  return below.x > above.x + rate * std::abs(a.s - b.s) + tolerated_s;
}

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

/// By how much a bound excludes all that the certificate leaves, s; not positive: it does not. What
/// was left a moment ago serves as well, until bounds have come that leave less.
double ClockPiece::violation(const Bound& e) {
  if (!certificate_.bounded()) return 0.0;
  if (!range_ || e.s - range_at_ > stale_s || unseen_ >= seldom) ask(e.s);
  if (!range_) return 0.0;
  const double d = e.s - range_at_;
  const double bent = assumptions().curvature * d * d / 2.0;
  const double low =
      range_->low + std::min(range_->least_slope * d, range_->greatest_slope * d) - bent;
  const double high =
      range_->high + std::max(range_->least_slope * d, range_->greatest_slope * d) + bent;
  unseen_ += (e.side == Side::above ? e.x < high : e.x > low) ? 1 : 0;
  return e.side == Side::above ? low - e.x : e.x - high;
}

void ClockPiece::add(const Bound& b) {
  const SlopeBelief slope = estimate_.slope();
  certificate_.add(b);
  estimate_.add(b);
  floors_.add(b, slope);
  journal_.add(b);
}

ClockPiece::Verdict ClockPiece::push(const Crossing& crossing) {
  const Bound e = bound(crossing);
  heard_ = crossing.heard;
  ++crossings_;
  if (std::abs(e.s) > longest_piece_s || std::abs(e.x) > longest_piece_s) {
    amount_ = std::abs(e.x);
    return Verdict::violator;  // no counter that begins to count says that
  }
  amount_ = violation(e);
  if (amount_ > tolerated_s) return judge(crossing);
  Verdict verdict = Verdict::taken;
  if (certificate_.bounded() && !range_) {
    if (!relax(e.s)) {
      end_ = End::contradiction;
      return Verdict::broken;
    }
    verdict = Verdict::relaxed;
  }
  add(e);
  return slipped().value_or(verdict);
}

/// A step by less than the least delay leaves the truth within the certificate.
std::optional<ClockPiece::Verdict> ClockPiece::slipped() {
  if (floors_.windows() == windows_judged_ && estimate_.changes() == routes_judged_) return {};
  if (const auto by = narrowed()) {
    amount_ = *by;
    if (relax(floors_.window(0)->s) && !narrowed()) return Verdict::relaxed;
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

/// Bounds of before and after a slip leave less between them than the shortest round trip that
/// there is; told once a window.
std::optional<double> ClockPiece::narrowed() const {
  if (floors_.windows() == windows_judged_) return std::nullopt;
  const auto window = floors_.window(0);
  if (!window) return std::nullopt;
  const double least = floors_.shortest().least_width();
  const auto range = certificate_.at(window->s);
  const double left = range ? range->high - range->low : 0.0;
  return left < least ? std::optional(least - left) : std::nullopt;
}

/// Told once a change of route.
std::optional<double> ClockPiece::stepped_with_route() {
  const auto& change = estimate_.last_change();
  if (!change || !change->step || estimate_.changes() == routes_judged_) return std::nullopt;
  routes_judged_ = estimate_.changes();
  return change->step;
}

/// Asked once a window. Where routes are seen to change, windows of two of them are not alike.
std::optional<double> ClockPiece::stepped_between_windows() {
  if (floors_.windows() == windows_judged_) return std::nullopt;
  windows_judged_ = floors_.windows();
  const auto& change = estimate_.last_change();
  const bool one_route =
      !change || journal_.newest(0).s - change->s > FloorLog::longest_reach_s + FloorLog::window_s;
  return one_route ? floors_.step() : std::nullopt;
}

/// Once a node bends more than assumed, what is just enough would put the truth at the edge: so far
/// as crystals go. False: even that leaves no way.
bool ClockPiece::relax(double s) {
  if (assumptions().curvature >= most_curvature) return false;
  Certificate relaxed = certificate_.relaxed(most_curvature);
  if (!relaxed.at(s)) return false;
  certificate_ = std::move(relaxed);
  ask(s);
  return true;
}

bool ClockPiece::recent(std::size_t violator) const {
  return heard_ - violators_[violator].heard <= violators_within ||
         crossings_ - violator_numbers_[violator] <= few_crossings;
}

std::optional<HostTime> ClockPiece::uneasy_since() const {
  if (violator_count_ == 0 || !recent(violator_count_ - 1)) return std::nullopt;
  return std::max(begin_, violators_[0].heard - violators_within);
}

/// A node that warms up faster than assumed bends away from the certificate bit by bit: three
/// violators that a greater curvature explains are no step.
ClockPiece::Verdict ClockPiece::judge(const Crossing& violator) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < violator_count_; ++i) {
    if (!recent(i)) continue;
    violators_[kept] = violators_[i];
    violator_numbers_[kept++] = violator_numbers_[i];
  }
  violators_[kept] = violator;
  violator_numbers_[kept] = crossings_;
  violator_count_ = kept + 1;
  if (violator_count_ < violators_.size()) return Verdict::violator;
  const Certificate before = certificate_;
  for (const Crossing& v : violators_) certificate_.add(bound(v));
  if (!relax(bound(violator).s)) {
    certificate_ = before;
    end_ = End::violators;
    return Verdict::broken;
  }
  for (const Crossing& v : violators_) add(bound(v));
  violator_count_ = 0;
  return Verdict::relaxed;
}

/// Behind the last crossing that can't go with the violators: until then the counter had not
/// stepped. At least five seconds before the first violator.
HostTime ClockPiece::doubt_of_violators() const {
  HostTime since = next_begins() - violators_within;
  for (std::size_t i = 0; i < journal_.size(); ++i) {
    const Bound e = journal_.newest(i);
    for (const Crossing& v : violators_) {
      if (contradict(e, bound(v), assumptions().rate)) return std::min(host_time(e), since);
    }
  }
  return begin_;
}

HostTime ClockPiece::doubtful_since() const {
  HostTime since = begin_;
  if (end_ == End::violators) since = doubt_of_violators();
  if (end_ == End::slip_with_route) since = about(estimate_.last_change()->s) - before_a_slip;
  if (end_ == End::slip_between_windows) since = heard_ - longest_reach;
  return std::max(since, begin_);
}

HostTime ClockPiece::next_begins() const {
  if (end_ != End::violators) return heard_;
  return std::min({violators_[0].heard, violators_[1].heard, violators_[2].heard});
}

/// When the host heard of what happened at s, but for delays.
HostTime ClockPiece::about(double s) const {
  std::size_t i = 0;
  while (i + 1 < journal_.size() && journal_.newest(i).s > s) ++i;
  return origin_.host + rounded_down(s + journal_.newest(i).x);
}

/// When just a counter stepped by little is not known well: nothing is certified by what came
/// before now. The estimate has begun anew with its route, or does so with the last window.
ClockPiece ClockPiece::next_after_slip(const SlopeBelief& prior) const {
  ClockPiece next = *this;
  next.begin_ = heard_;
  next.end_ = End::none;
  next.certificate_ = Certificate(assumptions(), corners);
  next.range_.reset();
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

ClockPiece ClockPiece::next_piece() const {
  SlopeBelief prior = estimate_.slope();
  prior.deviation += between_pieces;
  if (end_ == End::slip_with_route || end_ == End::slip_between_windows) {
    return next_after_slip(prior);
  }
  if (end_ == End::violators) {
    ClockPiece next({violators_[0].n, violators_[0].h}, assumptions(), prior, floors_.shortest());
    for (const Crossing& v : violators_) next.add(next.bound(v));
    next.begin_ = next.heard_ = next_begins();
    return next;
  }
  const Bound last = journal_.newest(0);
  ClockPiece next({origin_.node + rounded_down(last.s), host_time(last)}, assumptions(), prior,
                  floors_.shortest());
  next.begin_ = next.heard_ = heard_;
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
    x = std::clamp(x, range->low, range->high);
    stamp.earliest = origin_.host + rounded_down(s + range->low);
    stamp.latest = origin_.host + rounded_up(s + range->high + counter_resolution_s);
    if (certificate_.bounded()) {
      stamp.certainty = uneasy_since() ? Certainty::doubtful : Certainty::certified;
    }
  } else {
    stamp.certainty = Certainty::doubtful;
  }
  stamp.time = origin_.host + Duration{std::llround((s + x + counter_resolution_s / 2.0) * 1e9)};
  return stamp;
}

}  // namespace kinalign
