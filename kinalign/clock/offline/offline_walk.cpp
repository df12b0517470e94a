// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/offline_walk.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

// Returns whether the live clock begins a new piece with this event.
bool begins_piece(ClockEvent::Kind kind) {
  using Kind = ClockEvent::Kind;
  return kind == Kind::new_boot || kind == Kind::step || kind == Kind::slip ||
         kind == Kind::settled || kind == Kind::host_backwards;
}

/// The host's clock went back at exchange i. The times that the clock shows twice are doubtful.
void doubt_repeated_times(OfflineWalk& walk, std::size_t i, const ClockEvent& event) {
  HostTime newest = event.begin;
  for (std::size_t k = i; k < walk.exchanges.size() && newest < event.end; ++k) {
    if (walk.exchanges[k].h_rx < newest) break;  // the host's clock went back again
    newest = walk.exchanges[k].h_rx;
  }
  const DoubtfulStretch twice{std::max(event.begin, walk.earliest), std::min(event.end, newest)};
  if (twice.begin <= twice.end) walk.doubtful.push_back(twice);
}

/// Records an event of exchange i. If a new piece begins, its exchanges are assigned to the piece.
void note(OfflineWalk& walk, std::size_t i, const ClockEvent& event, Side of,
          const ClockPiece& now) {
  if (event.kind == ClockEvent::Kind::withdrawn) {
    // The cause was reported before, except if a reboot came before a step was confirmed.
    const ClockEvent& why = walk.events.back();
    const HostTime end = begins_piece(why.kind) ? why.begin - Duration{1} : event.end;
    if (event.begin <= end) walk.doubtful.push_back({event.begin, end});
    return;
  }
  walk.events.push_back(event);
  if (event.kind == ClockEvent::Kind::host_backwards) doubt_repeated_times(walk, i, event);
  if (event.kind == ClockEvent::Kind::violator)
    (of == Side::below ? walk.echo_left_out : walk.up_left_out)[i] = true;
  if (!begins_piece(event.kind)) return;
  const std::size_t next = walk.pieces.size();
  walk.pieces.push_back({now.assumptions(), now.certified_from()});
  const auto is_of_it = [&](std::size_t k) {
    const Exchange& e = walk.exchanges[k];
    // Only this exchange moves to the new piece.
    if (event.kind == ClockEvent::Kind::host_backwards) return k == i;
    return e.h_rx >= event.begin && (walk.late[k] || e.boot == event.boot);
  };
  // A step is noticed some exchanges after it happened. The exchanges in between are assigned to
  // the new piece.
  for (std::size_t k = i + 1; k-- > 0 && is_of_it(k);) walk.piece[k] = next;
}

/// An ignored crossing may be the first after a step that was not confirmed, because the counter
/// stepped back, rebooted or the recording ended. The live clock withdraws the five seconds before
/// the crossing. The five seconds after it are doubtful as well.
void doubt_behind_violators(OfflineWalk& walk) {
  for (std::size_t i = 0; i < walk.exchanges.size(); ++i) {
    if (!walk.up_left_out[i] && !walk.echo_left_out[i]) continue;
    const HostTime h = walk.exchanges[i].h_rx;
    const Exchange& last = walk.exchanges[range_of(walk, walk.piece[i]).end - 1];
    walk.doubtful.push_back({h, std::min(last.h_rx, h + Violators::wait)});
  }
}

/// Merges overlapping stretches. The result is in rising order.
std::vector<DoubtfulStretch> merged(std::vector<DoubtfulStretch> all) {
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
  std::vector<DoubtfulStretch> out;
  for (const DoubtfulStretch& d : all) {
    if (out.empty() || d.begin > out.back().end) {
      out.push_back(d);
    } else {
      out.back().end = std::max(out.back().end, d.end);
    }
  }
  return out;
}

/// Records the live clock's events after exchange i or its echo.
void observe(OfflineWalk& walk, std::size_t i, LiveClock& clock, Side of) {
  for (const ClockEvent& event : clock.take_events()) note(walk, i, event, of, *clock.piece());
}

// Returns whether the event ends a piece even if a step is not confirmed yet.
bool cuts_short(ClockEvent::Kind kind) {
  return kind == ClockEvent::Kind::new_boot || kind == ClockEvent::Kind::host_backwards;
}

}  // namespace

ExchangeRange range_of(const OfflineWalk& walk, std::size_t p) {
  const auto [first, last] = std::equal_range(walk.piece.begin(), walk.piece.end(), p);  // sorted
  return {static_cast<std::size_t>(first - walk.piece.begin()),
          static_cast<std::size_t>(last - walk.piece.begin())};
}

OfflineWalk walk_offline(std::span<const Exchange> exchanges, const Assumptions& assumptions) {
  OfflineWalk walk;
  walk.exchanges = exchanges;
  walk.piece.resize(exchanges.size());
  walk.up_left_out.resize(exchanges.size());
  walk.echo_left_out.resize(exchanges.size());
  walk.late.resize(exchanges.size());
  LiveClock clock(assumptions);
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    const Exchange& e = exchanges[i];
    // The newest piece so far. `note` changes this value if a piece begins with this exchange.
    walk.piece[i] = walk.pieces.empty() ? 0 : walk.pieces.size() - 1;
    const auto late = clock.late_crossings();
    const auto unsettled = clock.unsettled_since();
    clock.push_up(e.boot, e.n_tx, e.h_rx);
    if (clock.late_crossings() > late) {
      walk.late[i] = true;
      continue;
    }
    observe(walk, i, clock, Side::above);
    walk.earliest = std::min(walk.earliest, e.h_rx);
    if (unsettled && cuts_short(walk.events.back().kind))  // the clock was waiting after a step
      walk.doubtful.push_back({*unsettled, exchanges[i - 1].h_rx});
    if (e.echo) {
      clock.push_down(e.boot, e.echo->n_rx, e.echo->h_tx);
      observe(walk, i, clock, Side::below);
    }
    // The call updates the estimate, so that the walk gives the same result as a clock in use.
    static_cast<void>(clock.host_from_node(e.boot, e.n_tx));
  }
  if (const ClockPiece* last = clock.piece()) {
    walk.least_width = last->floors().least_width();
    for (const auto& since : {last->step_pending_since(), clock.unsettled_since()}) {
      if (since) walk.doubtful.push_back({*since, exchanges.back().h_rx});
    }
  }
  doubt_behind_violators(walk);
  walk.doubtful = merged(std::move(walk.doubtful));
  return walk;
}

}  // namespace kinalign
