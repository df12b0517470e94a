// SPDX-License-Identifier: Apache-2.0
// The clock of one node during recording. It converts counter readings to host times with an
// interval, from the exchanges so far. Each node has one object of fixed size, about 60 KiB.
//
//   frame to the host:  n_tx (T1 of RFC 5905, read by the node)  ->  h_rx (T2, read by the host)
//   reply to the node:  h_tx (T3, read by the host)              ->  n_rx (T4, read by the node)
//
// The two directions need not be paired. If a reply is lost, its frame still gives an upper bound
// of the offset. A reply is pushed when a later frame has brought its echo.
#pragma once

#include "kinalign/clock/clock_event.h"
#include "kinalign/clock/clock_stamp.h"
#include "kinalign/clock/host_from_node.h"
#include "kinalign/clock/live/clock_piece.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

class LiveClock {
 public:
  explicit LiveClock(const Assumptions& assumptions = {}) : assumptions_(assumptions) {}

  /// Adds a frame with its echo. Call in the order of arrival.
  void push(const Exchange& exchange);
  /// Adds a frame without its echo; the first half of push().
  void push_up(BootKey boot, NodeTime n_tx, HostTime h_rx);
  /// Adds an echo, the second half of push(): the reply sent at h_tx arrived at the node at n_rx.
  void push_down(BootKey boot, NodeTime n_rx, HostTime h_tx);

  /// Returns the time at which the counter of this boot showed n. The call stores its computation
  /// for the next crossing. Stamps may therefore depend on how often it is called, by less than
  /// their noise. Absent if there are too few exchanges, and for earlier boots; the offline clock
  /// covers these.
  std::optional<ClockStamp> host_from_node(BootKey boot, NodeTime n);

  /// Returns the events since the last call, at most 64. `missed_events` counts further events.
  /// Withdrawals are never lost: if the list is full, the last withdrawal is extended.
  std::vector<ClockEvent> take_events();
  std::uint64_t missed_events() const { return missed_events_; }
  std::uint64_t late_crossings() const { return late_; }  // packets of earlier boots

  /// The time since which nothing is certified because of a recent step. Absent if there was no
  /// recent step.
  std::optional<HostTime> unsettled_since() const {
    return settles_ ? std::optional(piece_->begins()) : std::nullopt;
  }
  /// The present piece of the counter; nullptr before the first frame.
  const ClockPiece* piece() const { return piece_ ? &*piece_ : nullptr; }

 private:
  void cut_short();
  void begin(BootKey boot, const Crossing& first);
  void take_piece(const ClockPiece& piece);
  void answer(ClockPiece::Verdict verdict, const Crossing& crossing);
  bool replace_piece(ClockEvent::Kind why, std::optional<double> by, const Crossing& crossing);
  void take_step(const Crossing& crossing);
  void settle(const Crossing& crossing);
  void report(const ClockEvent& event);

  Assumptions assumptions_;
  std::optional<ClockPiece> piece_;
  BootKey boot_ = 0;
  std::array<BootKey, 256> earlier_{};  // boots before the present one
  std::size_t boots_ = 0;
  HostTime newest_ = HostTime::min();
  std::optional<HostTime> stepped_;  // the latest step in this boot
  bool replaced_ = false;            // the newest frame has ended the previous piece
  std::optional<HostTime> settles_;  // stamps are certified from then on if no other step comes
  std::uint32_t routes_reported_ = 0;
  std::uint64_t late_ = 0;
  std::vector<ClockEvent> events_;
  std::uint64_t missed_events_ = 0;
};

}  // namespace kinalign
