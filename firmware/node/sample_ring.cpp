// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/sample_ring.h"

namespace kinalign {

bool SampleRing::push(const TakenSample& sample) {
  samples_[(first_ + size_) % capacity] = sample;
  if (size_ < capacity) {
    ++size_;
    return true;
  }
  first_ = (first_ + 1) % capacity;
  return false;
}

std::size_t SampleRing::pop(std::span<TakenSample> out) {
  std::size_t moved = 0;
  while (moved < out.size() && size_ > 0) {
    out[moved++] = samples_[first_];
    first_ = (first_ + 1) % capacity;
    --size_;
  }
  return moved;
}

}  // namespace kinalign
