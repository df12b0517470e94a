// SPDX-License-Identifier: Apache-2.0
// The time model of a whole recording. It maps a node's counter to the host's axis, in pieces, each
// with an interval that holds the truth under stated assumptions.
#pragma once

#include "kinalign/clock/clock_stamp.h"
#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// The offset, host minus node, at one reading of the counter: its likeliest value and the ends of
/// its interval.
struct ClockKnot {
  NodeTime node{};
  Duration offset{}, least{}, greatest{};
};

/// A continuous stretch of the counter within one boot. Knots are a second apart; between them all
/// three values are straight lines.
struct ClockPieceModel {
  BootKey boot = 0;
  HostTime first{}, last{};      // arrivals of its first and last frame, both included
  std::vector<ClockKnot> knots;  // at least one, if anything is known
  bool certified = false;  // there are bounds of both kinds, and they don't contradict each other
  /// Assumptions of the certificate: those of the live clock for this piece.
  Assumptions assumptions;
  /// Numbers of upper bounds, lower bounds, crossings left out, and routes of the packets.
  std::uint64_t up = 0, down = 0, violators = 0, routes = 0;
  Duration round_trip{};                      // the shortest
  HostTime certified_from = HostTime::min();  // earlier readings may come from before a step
};

/// Frames that arrived in this stretch have no certified stamps, because a counter stepped around
/// then.
struct DoubtfulStretch {
  HostTime begin{}, end{};
};

struct HostFromNode {
  std::vector<ClockPieceModel> pieces;    // in the order of arrival
  std::vector<DoubtfulStretch> doubtful;  // in rising order, without overlap
};

/// True if h lies in one of the stretches, which are in rising order without overlap.
bool is_in(std::span<const DoubtfulStretch> doubtful, HostTime h);

/// The time at which the counter read n, by the piece of that boot that covers the arrival h_rx of
/// its frame. Absent if there is no such piece, or if it has no knots.
std::optional<ClockStamp> host_from_node(const HostFromNode& model, BootKey boot, NodeTime n,
                                         HostTime h_rx);

}  // namespace kinalign
