// SPDX-License-Identifier: Apache-2.0
// The sampling half of a node. It knows of no exchange with the host and waits for none.
#pragma once

#include "firmware/node/board.h"
#include "firmware/node/sample_ring.h"

namespace kinalign {

struct SampleCounts {
  std::uint64_t ticks = 0;         // ticks of the sample timer
  std::uint64_t taken = 0;         // samples that were taken
  std::uint64_t missed = 0;        // ticks that passed before they were handled: no sample
  std::uint64_t sensor_fails = 0;  // samples without values: the sensor did not answer
  std::uint64_t dropped = 0;       // oldest samples that were dropped for want of room
};

class Sampler {
 public:
  explicit Sampler(Board& board) : board_(board) {}

  /// Takes one sample, however many ticks are due. Missed ticks are counted; they get no sample.
  void tick(std::uint32_t due);
  /// Moves the oldest samples to `out`; gives their number.
  std::size_t take(std::span<TakenSample> out);
  /// Whether there is no room for another sample: the next tick would drop the oldest.
  bool full();
  /// Counts samples that were taken and are dropped before they were sent.
  void count_dropped(std::size_t n);
  SampleCounts counts();

 private:
  Board& board_;
  SampleRing ring_;
  SampleCounts counts_;
};

}  // namespace kinalign
