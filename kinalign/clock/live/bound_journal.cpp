// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/bound_journal.h"

#include <algorithm>

namespace kinalign {

void BoundJournal::add(const Bound& bound) {
  places_[next_] = {bound.s, bound.x};
  below_[next_] = bound.side == Side::below;
  next_ = (next_ + 1) % capacity;
  size_ = std::min(size_ + 1, capacity);
}

Bound BoundJournal::newest(std::size_t i) const {
  const std::size_t place = (next_ + capacity - 1 - i) % capacity;
  return {places_[place].s, places_[place].x, below_[place] ? Side::below : Side::above};
}

}  // namespace kinalign
