// SPDX-License-Identifier: Apache-2.0
// The samples that wait for a frame, first in, first out. If there is no room the oldest are
// dropped: after a time without radio the newest samples matter most.
#pragma once

#include "kinalign/wire/node_sample.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

struct TakenSample {
  std::uint64_t counter_us = 0;  // counter when it was taken
  NodeSample sample;             // its age is not set: that depends on the frame
};

class SampleRing {
 public:
  static constexpr std::size_t capacity = 512;  // 2.5 s at 200 Hz: roaming takes up to 2 s

  /// False: the oldest sample was dropped to make room.
  bool push(const TakenSample& sample);
  /// Moves the oldest samples to `out`, as many as there are and as fit; gives their number.
  std::size_t pop(std::span<TakenSample> out);
  std::size_t size() const { return size_; }

 private:
  std::array<TakenSample, capacity> samples_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace kinalign
