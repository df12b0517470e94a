// SPDX-License-Identifier: Apache-2.0
// The samples that wait for a frame, first in, first out. Where there is no room the oldest go: a
// node that comes back from a bad radio is to say what is, not what was.
#pragma once

#include "kinalign/wire/node_sample.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

struct TakenSample {
  std::uint64_t counter_us = 0;  // when it was taken
  NodeSample sample;             // without an age: that depends on the frame
};

class SampleRing {
 public:
  static constexpr std::size_t capacity = 512;  // 2.5 s at 200 Hz: roaming takes up to 2 s

  /// False where the oldest had to go for it.
  bool push(const TakenSample& sample);
  /// Moves the oldest ones to `out`, as many as there are and as it holds; how many.
  std::size_t pop(std::span<TakenSample> out);
  std::size_t size() const { return size_; }

 private:
  std::array<TakenSample, capacity> samples_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace kinalign
