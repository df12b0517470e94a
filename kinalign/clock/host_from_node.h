// SPDX-License-Identifier: Apache-2.0
// The time model of a whole recording: from a node's counter to the host's axis, in pieces, each
// with an interval that holds the truth under stated assumptions.
#pragma once

#include "kinalign/clock/clock_stamp.h"
#include "kinalign/clock/exchange.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// The offset host minus node at one reading of the counter: likeliest and ends.
struct ClockKnot {
  NodeTime node{};
  Duration offset{}, least{}, greatest{};
};

/// A stretch of one life without a break. Between knots, a second apart, all three are straight.
struct ClockPieceModel {
  BootKey boot = 0;
  HostTime first{}, last{};      // arrival of its frames, both included
  std::vector<ClockKnot> knots;  // at least one where anything is known
  bool certified = false;        // bounds of both kinds, and they go together
  Assumptions assumptions;       // under which: those of the live clock then
  std::uint64_t up = 0, down = 0, violators = 0, routes = 0;
  Duration round_trip{};                      // the least
  HostTime certified_from = HostTime::min();  // readings of before may be of before a step
};

/// Stamps of frames that arrived in there are not certified: a counter stepped about then.
struct DoubtfulStretch {
  HostTime begin{}, end{};
};

struct HostFromNode {
  std::vector<ClockPieceModel> pieces;    // in the order of arrival
  std::vector<DoubtfulStretch> doubtful;  // rising, apart from each other
};

/// Whether h is within one of these, rising and apart.
bool is_in(std::span<const DoubtfulStretch> doubtful, HostTime h);

/// When the counter read n, in the piece of a frame of that life that arrived at h_rx. Absent where
/// no piece is of that life and time, or nothing is known of it.
std::optional<ClockStamp> host_from_node(const HostFromNode& model, BootKey boot, NodeTime n,
                                         HostTime h_rx);

}  // namespace kinalign
