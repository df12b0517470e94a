// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/exchange_journal.h"

#include <algorithm>

namespace kinalign {

Bound bound_by(const ClockOrigin& origin, Side side, NodeTime n, HostTime h) {
  const Duration node = n - origin.node;
  const Duration offset = (h - origin.host) - node;
  const double early = side == Side::below ? counter_resolution_s : 0.0;
  return {seconds(node), seconds(offset) - early, side};
}

void ExchangeJournal::add(const Bound& bound) {
  places_[next_] = {bound.s, bound.x};
  below_[next_] = bound.side == Side::below;
  next_ = (next_ + 1) % capacity;
  size_ = std::min(size_ + 1, capacity);
}

Bound ExchangeJournal::newest(std::size_t i) const {
  const std::size_t place = (next_ + capacity - 1 - i) % capacity;
  return {places_[place].s, places_[place].x, below_[place] ? Side::below : Side::above};
}

}  // namespace kinalign
