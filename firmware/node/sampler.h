// SPDX-License-Identifier: Apache-2.0
// The half of a node that samples. It knows of no exchange and waits for none.
#pragma once

#include "firmware/node/board.h"
#include "firmware/node/sample_ring.h"

namespace kinalign {

struct SampleCounts {
  std::uint64_t ticks = 0;         // of the sample timer
  std::uint64_t taken = 0;         // samples
  std::uint64_t missed = 0;        // ticks that were over before they were seen: no sample
  std::uint64_t sensor_fails = 0;  // samples without values: the sensor did not answer
  std::uint64_t dropped = 0;       // the oldest ones, for want of room
};

class Sampler {
 public:
  explicit Sampler(Board& board) : board_(board) {}

  /// One sample however many ticks are due: what was missed is counted, not made up.
  void tick(std::uint32_t due);
  /// The oldest samples, moved to `out`; how many.
  std::size_t take(std::span<TakenSample> out);
  /// No room for another: the next tick drops the oldest.
  bool full();
  /// Of samples that were taken and did not get away.
  void count_dropped(std::size_t n);
  SampleCounts counts();

 private:
  Board& board_;
  SampleRing ring_;
  SampleCounts counts_;
};

}  // namespace kinalign
