// SPDX-License-Identifier: Apache-2.0
// The first half of the offline clock: the live one walks through all exchanges of a recording and
// says where pieces begin, which stretches are in doubt and what can't be.
#pragma once

#include "kinalign/clock/live/live_clock.h"

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

struct OfflineWalk {
  /// Of a piece, as the live clock had it when it began.
  struct Piece {
    Assumptions assumptions;
    HostTime certified_from;
  };
  std::span<const Exchange> exchanges;
  std::vector<ClockEvent> events;
  std::vector<DoubtfulStretch> doubtful;  // rising, apart from each other
  std::vector<Piece> pieces;
  // of each exchange:
  std::vector<std::size_t> piece;                // rising
  std::vector<bool> up_left_out, echo_left_out;  // it, or what it echoes, can't be
  std::vector<bool> late;                        // its life was over when it came
  HostTime earliest = HostTime::max();           // arrival, so far
  double least_width = 0.0;  // s, that an interval can have: packets took no less, there and back
};

/// Exchanges in the order of arrival; they have to stay.
OfflineWalk walk_offline(std::span<const Exchange> exchanges, const Assumptions& assumptions);

/// The exchanges of piece p, which follow each other.
struct ExchangeRange {
  std::size_t begin = 0, end = 0;
};
ExchangeRange range_of(const OfflineWalk& walk, std::size_t p);

}  // namespace kinalign
