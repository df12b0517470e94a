// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/live_clock.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_events = 64;
constexpr Duration settling = Violators::wait;  // waiting time after several steps
// Waiting time after a single step, because late frames may be from before the step.
constexpr Duration late_frames = std::chrono::seconds(1);

}  // namespace

/// Queues an event. If the queue is full, a withdrawal extends an earlier withdrawal.
void LiveClock::report(const ClockEvent& event) {
  if (events_.size() < most_events) return events_.push_back(event);
  ++missed_events_;
  if (event.kind != ClockEvent::Kind::withdrawn) return;
  const auto last = std::find_if(events_.rbegin(), events_.rend(), [](const ClockEvent& e) {
    return e.kind == ClockEvent::Kind::withdrawn;
  });
  if (last == events_.rend()) {
    events_.back() = event;
  } else {
    *last = {event.kind, event.boot, std::min(last->begin, event.begin),
             std::max(last->end, event.end)};
  }
}

std::vector<ClockEvent> LiveClock::take_events() { return std::exchange(events_, {}); }

/// Ends the present piece early. If a step is suspected but not confirmed, its stamps become
/// doubtful.
void LiveClock::cut_short() {
  if (const auto since = piece_->step_pending_since()) {
    report({ClockEvent::Kind::withdrawn, boot_, *since, newest_});
  }
  stepped_.reset();
  settles_.reset();
}

// After a new boot the counter is new, but the crystal is the same. The slope and the shortest
// round trips are therefore still valid.
void LiveClock::begin(BootKey boot, const Crossing& first) {
  SlopeBelief prior;
  if (piece_) {  // the crystal is the same as before
    cut_short();
    prior = piece_->estimate().slope().after_a_break();
    earlier_[boots_++ % earlier_.size()] = boot_;
  }
  take_piece({ClockOrigin{first.n, first.h}, assumptions_, prior,
              piece_ ? piece_->floors().shortest() : ShortestRoundTrips{}});
  boot_ = boot;
  report({ClockEvent::Kind::new_boot, boot, first.h, first.h});
}

void LiveClock::take_piece(const ClockPiece& piece) {
  piece_ = piece;
  routes_reported_ = piece_->estimate().changes();
}

void LiveClock::push(const Exchange& exchange) {
  push_up(exchange.boot, exchange.n_tx, exchange.h_rx);
  if (exchange.echo) push_down(exchange.boot, exchange.echo->n_rx, exchange.echo->h_tx);
}

void LiveClock::push_up(BootKey boot, NodeTime n_tx, HostTime h_rx) {
  const Crossing crossing{Side::above, n_tx, h_rx, h_rx};
  const auto boots_end =
      earlier_.begin() + static_cast<std::ptrdiff_t>(std::min(boots_, earlier_.size()));
  if (piece_ && boot != boot_ && std::find(earlier_.begin(), boots_end, boot) != boots_end) {
    ++late_;
    return;
  }
  if (!piece_ || boot != boot_) begin(boot, crossing);
  // The host's clock must never go back (H1). If it does, a new piece begins, because bounds from
  // before and after don't fit together.
  if (h_rx < newest_) {
    cut_short();
    take_piece({ClockOrigin{n_tx, h_rx}, assumptions_, piece_->estimate().slope(),
                piece_->floors().shortest()});
    report({ClockEvent::Kind::host_backwards, boot, h_rx, newest_});
  }
  newest_ = h_rx;
  replaced_ = false;
  answer(piece_->push(crossing), crossing);
  if (settles_ && newest_ >= *settles_) settle(crossing);
}

void LiveClock::push_down(BootKey boot, NodeTime n_rx, HostTime h_tx) {
  if (!piece_ || boot != boot_) {
    ++late_;
    return;
  }
  if (replaced_) return;  // the echo is from before the break that the frame revealed
  const Crossing crossing{Side::below, n_rx, h_tx, newest_};
  answer(piece_->push(crossing), crossing);
}

/// Handles the verdict on a crossing: reports events and replaces the piece if necessary.
void LiveClock::answer(ClockPiece::Verdict verdict, const Crossing& crossing) {
  using Verdict = ClockPiece::Verdict;
  using Kind = ClockEvent::Kind;
  if (piece_->estimate().changes() != routes_reported_) {
    routes_reported_ = piece_->estimate().changes();
    report({Kind::route, boot_, crossing.arrival, crossing.arrival});
  }
  switch (verdict) {
    case Verdict::taken:
      return;
    case Verdict::violator:
      report({Kind::violator, boot_, crossing.arrival, crossing.arrival, piece_->amount()});
      // If the violator is right, the counter has stepped. The counter may step back before three
      // violators have confirmed the step.
      return report({Kind::withdrawn, boot_,
                     std::max(crossing.arrival - Violators::wait, piece_->begins()),
                     crossing.arrival});
    case Verdict::uneasy:
      return report({Kind::uneasy, boot_, crossing.arrival, crossing.arrival, piece_->amount()});
    case Verdict::broken:
      return take_step(crossing);
    case Verdict::slipped:
      replace_piece(Kind::slip, piece_->amount(), crossing);
      return;
  }
}

/// The counter of a sleeping node may run at another rate. The clock then seems to step repeatedly.
/// Each step is as small as for a counter of changing rate.
void LiveClock::take_step(const Crossing& crossing) {
  const bool relaxed = replace_piece(ClockEvent::Kind::step, piece_->amount(), crossing);
  const bool again = stepped_ && newest_ - *stepped_ < settling;
  settles_ = newest_ + (again || relaxed ? settling : late_frames);
  stepped_ = newest_;
}

void LiveClock::settle(const Crossing& crossing) {
  settles_.reset();
  replace_piece(ClockEvent::Kind::settled, std::nullopt, crossing);
}

/// Replaces the piece. Returns whether the new piece allows a greater curvature.
bool LiveClock::replace_piece(ClockEvent::Kind why, std::optional<double> by,
                              const Crossing& crossing) {
  replaced_ = true;
  report({why, boot_, piece_->next_begins(), crossing.arrival, by});
  report({ClockEvent::Kind::withdrawn, boot_, piece_->doubtful_since(), newest_});
  const double assumed = piece_->assumptions().curvature;
  take_piece(piece_->next_piece());
  const double curvature = piece_->assumptions().curvature;
  if (curvature == assumed) return false;
  report({ClockEvent::Kind::relaxed, boot_, crossing.arrival, crossing.arrival, std::nullopt,
          curvature});
  return true;
}

std::optional<ClockStamp> LiveClock::host_from_node(BootKey boot, NodeTime n) {
  if (!piece_ || boot != boot_) return std::nullopt;
  auto stamp = piece_->at(n);
  if (stamp && settles_) stamp->certainty = Certainty::doubtful;
  return stamp;
}

}  // namespace kinalign
