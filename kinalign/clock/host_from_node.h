// SPDX-License-Identifier: Apache-2.0
// The time model of a node for a whole recording. It converts readings of the node's counter to
// host times. It consists of pieces; each gives an interval that contains the true time under
// stated assumptions.
#pragma once

#include "kinalign/clock/clock_stamp.h"
#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// The offset, host minus node, at one reading of the counter: the likeliest value and the ends of
/// its interval.
struct ClockKnot {
  NodeTime node{};
  Duration offset{}, least{}, greatest{};
};

/// The model for a continuous stretch of the counter within one boot. Knots are a second apart.
/// Between knots the three values are interpolated linearly.
struct ClockPieceModel {
  BootKey boot = 0;
  HostTime first{}, last{};      // arrivals of the first and the last frame of the piece
  std::vector<ClockKnot> knots;  // at least one, if any bound is known
  bool certified = false;        // there are bounds of both kinds without contradiction
  /// Assumptions of the certificate: those of the live clock for this piece.
  Assumptions assumptions;
  /// Numbers of upper bounds, lower bounds, ignored packets, and routes of the packets.
  std::uint64_t up = 0, down = 0, violators = 0, routes = 0;
  Duration round_trip{};                      // the shortest round trip
  HostTime certified_from = HostTime::min();  // earlier readings may be from before a step
};

/// Frames that arrived in this stretch have no certified stamps, because the counter stepped near
/// it.
struct DoubtfulStretch {
  HostTime begin{}, end{};
};

struct HostFromNode {
  std::vector<ClockPieceModel> pieces;    // in the order of arrival
  std::vector<DoubtfulStretch> doubtful;  // in rising order, without overlap
};

/// Returns whether h lies in one of the stretches, which are in rising order without overlap.
bool is_in(std::span<const DoubtfulStretch> doubtful, HostTime h);

/// Returns the time at which the counter showed n. The piece is chosen by `boot` and by the arrival
/// h_rx of the frame. Absent if there is no such piece or if it has no knots.
std::optional<ClockStamp> host_from_node(const HostFromNode& model, BootKey boot, NodeTime n,
                                         HostTime h_rx);

}  // namespace kinalign
