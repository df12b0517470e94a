// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/exchange_journal.h"

#include <algorithm>

namespace kinalign {

JournalEntry bound_by(const ClockOrigin& origin, Bound bound, NodeTime n, HostTime h) {
  const Duration node = n - origin.node;
  const Duration offset = (h - origin.host) - node;
  const double early = bound == Bound::below ? counter_resolution_s : 0.0;
  return {seconds(node), seconds(offset) - early, bound};
}

void ExchangeJournal::add(const JournalEntry& entry) {
  places_[next_] = {entry.s, entry.x};
  below_[next_] = entry.bound == Bound::below;
  next_ = (next_ + 1) % capacity;
  size_ = std::min(size_ + 1, capacity);
}

JournalEntry ExchangeJournal::newest(std::size_t i) const {
  const std::size_t place = (next_ + capacity - 1 - i) % capacity;
  return {places_[place].s, places_[place].x, below_[place] ? Bound::below : Bound::above};
}

}  // namespace kinalign
