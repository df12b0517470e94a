// SPDX-License-Identifier: Apache-2.0
// The clock of one node, told while its frames arrive: from exchanges to host_from_node with an
// interval. One object a node; it does not grow: some 60 KiB.
//
//   frame up:    n_tx (T1 of RFC 5905, read by the node)  ->  h_rx (T2, read by the host)
//   its reply:   h_tx (T3, read by the host)              ->  n_rx (T4, read by the node)
//
// The two ways need no pairing: a frame whose reply was lost still bounds the offset from above,
// and a reply is pushed once a later frame has brought its echo.
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

  /// A frame of this life arrived, in the order of arrival; with its echo.
  void push(const Exchange& exchange);
  /// The halves of that: the frame, …
  void push_up(BootKey boot, NodeTime n_tx, HostTime h_rx);
  /// … and what it says: that the reply sent at h_tx reached the node at n_rx.
  void push_down(BootKey boot, NodeTime n_rx, HostTime h_tx);

  /// When the counter of this life read n. What it works out for that serves the next crossing,
  /// too: stamps may differ, by less than their noise, with how often it is asked. Absent where too
  /// little is known of that life, and for lives before the present one: the offline clock has
  /// those.
  std::optional<ClockStamp> host_from_node(BootKey boot, NodeTime n);

  /// What happened since this was asked last: at most 64, `missed_events` counts the rest. Of
  /// withdrawals none is lost: the last one then reaches over those that had no room.
  std::vector<ClockEvent> take_events();
  std::uint64_t missed_events() const { return missed_events_; }
  std::uint64_t late_crossings() const { return late_; }  // of earlier lives

  /// Since when nothing is certified for a step just seen. While it has not settled.
  std::optional<HostTime> unsettled_since() const {
    return settles_ ? std::optional(piece_->begins()) : std::nullopt;
  }
  /// The stretch of the counter that is being told; nullptr before the first frame.
  const ClockPiece* piece() const { return piece_ ? &*piece_ : nullptr; }

 private:
  void cut_short();
  void begin(BootKey boot, const Crossing& first);
  void take_piece(const ClockPiece& piece);
  void answer(ClockPiece::Verdict verdict, const Crossing& crossing);
  bool replace_piece(ClockEvent::Kind why, std::optional<double> by, const Crossing& crossing);
  void take_step(const Crossing& crossing);
  void settle(const Crossing& crossing);
  void tell(const ClockEvent& event);

  Assumptions assumptions_;
  std::optional<ClockPiece> piece_;
  BootKey boot_ = 0;
  std::array<BootKey, 256> earlier_{};  // lives
  std::size_t lives_ = 0;
  HostTime newest_ = HostTime::min();
  std::optional<HostTime> stepped_;  // last, in this life
  bool replaced_ = false;            // the piece, by the newest frame
  std::optional<HostTime> settles_;  // if there is no other
  std::uint32_t routes_told_ = 0;
  std::uint64_t late_ = 0;
  std::vector<ClockEvent> events_;
  std::uint64_t missed_events_ = 0;
};

}  // namespace kinalign
