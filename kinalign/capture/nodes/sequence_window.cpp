// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/sequence_window.h"

#include <algorithm>

namespace kinalign {

/// Steps from the newest number to `sequence`; negative: backwards.
std::int64_t SequenceWindow::steps_to(std::uint32_t sequence) const {
  return static_cast<std::int32_t>(sequence - static_cast<std::uint32_t>(newest_));
}

SequenceWindow::Place SequenceWindow::place_of(std::uint32_t sequence) const {
  if (!begun_) return Place::fresh;
  const std::int64_t steps = steps_to(sequence);
  if (steps > 0) return Place::fresh;
  if (-steps >= static_cast<std::int64_t>(size)) return Place::behind;
  return seen_[sequence % size] ? Place::seen : Place::fresh;
}

std::uint64_t SequenceWindow::take(std::uint32_t sequence) {
  if (!begun_) {
    // begins one turn above zero, so that numbers before the first are not negative
    first_ = newest_ = (std::uint64_t{1} << 32) + sequence;
    begun_ = true;
  }
  const std::int64_t steps = steps_to(sequence);
  // Numbers that are skipped are not received yet; their bits belonged to numbers 1024 before.
  for (std::int64_t i = 1; i <= std::min<std::int64_t>(steps, size); ++i) {
    seen_[(newest_ + static_cast<std::uint64_t>(i)) % size] = false;
  }
  const std::uint64_t wide = newest_ + static_cast<std::uint64_t>(steps);
  newest_ = std::max(newest_, wide);
  first_ = std::min(first_, wide);
  seen_[wide % size] = true;
  ++taken_;
  return wide;
}

}  // namespace kinalign
