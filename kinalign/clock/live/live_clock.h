// SPDX-License-Identifier: Apache-2.0
// The clock of one node while its frames arrive: from exchanges to host_from_node() with an
// interval. One object for each node; its size is fixed, some 60 KiB.
//
//   frame up:    n_tx (T1 of RFC 5905, read by the node)  ->  h_rx (T2, read by the host)
//   its reply:   h_tx (T3, read by the host)              ->  n_rx (T4, read by the node)
//
// The two directions need no pairing. A frame whose reply was lost still bounds the offset from
// above. A reply is pushed once a later frame has brought its echo.
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

  /// Takes a frame with its echo, in the order of arrival.
  void push(const Exchange& exchange);
  /// One half of push(): the frame.
  void push_up(BootKey boot, NodeTime n_tx, HostTime h_rx);
  /// The other half, the echo: the reply sent at h_tx reached the node at n_rx.
  void push_down(BootKey boot, NodeTime n_rx, HostTime h_tx);

  /// The time at which the counter of this boot read n. The computation is kept for the next
  /// crossing, so stamps may depend on how often this is called, by less than their noise. Absent
  /// if too little is known, and for earlier boots, which the offline clock covers.
  std::optional<ClockStamp> host_from_node(BootKey boot, NodeTime n);

  /// The events since the last call, at most 64; `missed_events` counts the others. Withdrawals are
  /// never lost: if there is no room, the last one is extended.
  std::vector<ClockEvent> take_events();
  std::uint64_t missed_events() const { return missed_events_; }
  std::uint64_t late_crossings() const { return late_; }  // crossings of earlier boots

  /// The time since when nothing is certified, because of a recent step. Absent once the clock has
  /// settled.
  std::optional<HostTime> unsettled_since() const {
    return settles_ ? std::optional(piece_->begins()) : std::nullopt;
  }
  /// The current piece of the counter; nullptr before the first frame.
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
  bool replaced_ = false;            // the newest frame has replaced the piece
  std::optional<HostTime> settles_;  // time at which the clock settles if there is no other step
  std::uint32_t routes_reported_ = 0;
  std::uint64_t late_ = 0;
  std::vector<ClockEvent> events_;
  std::uint64_t missed_events_ = 0;
};

}  // namespace kinalign
