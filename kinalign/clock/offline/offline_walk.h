// SPDX-License-Identifier: Apache-2.0
// First step of the offline clock. Passes all exchanges of a recording to the live clock. Finds the
// beginnings of pieces (stretches in which one model of the clock is valid), the doubtful stretches
// and the packets to ignore.
#pragma once

#include "kinalign/clock/live/live_clock.h"

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

/// Everything that the second step (offline_clock.cpp) needs; it does not use the live clock.
struct OfflineWalk {
  /// State of the live clock at the beginning of a piece.
  struct Piece {
    Assumptions assumptions;
    HostTime certified_from;
  };
  std::span<const Exchange> exchanges;
  std::vector<ClockEvent> events;
  std::vector<DoubtfulStretch> doubtful;  // in rising order, without overlap
  std::vector<Piece> pieces;
  // For each exchange:
  std::vector<std::size_t> piece;  // index of its piece; never decreases
  /// The frame, or its echo, contradicts the certificate and is ignored.
  std::vector<bool> up_left_out, echo_left_out;
  std::vector<bool> late;               // it arrived after its boot had ended
  HostTime earliest = HostTime::max();  // earliest of all arrivals so far
  /// s; least width of an interval, from the shortest round trip.
  double least_width = 0.0;
};

/// Exchanges must be in the order of arrival, and must outlive the result.
OfflineWalk walk_offline(std::span<const Exchange> exchanges, const Assumptions& assumptions);

/// The range of the exchanges of piece p, which are consecutive.
struct ExchangeRange {
  std::size_t begin = 0, end = 0;
};
ExchangeRange range_of(const OfflineWalk& walk, std::size_t p);

}  // namespace kinalign
