// SPDX-License-Identifier: Apache-2.0
// Keeps the bounds of a piece's latest exchanges, in their order. After a step of the counter they
// show since when stamps are in doubt.
#pragma once

#include "kinalign/clock/bound.h"

#include <array>
#include <bitset>
#include <cstddef>

namespace kinalign {

/// A ring of fixed size: a node's clock must not grow with the length of a recording.
class BoundJournal {
 public:
  void add(const Bound& bound);
  std::size_t size() const { return size_; }
  Bound newest(std::size_t i) const;  // 0: the latest one

 private:
  static constexpr std::size_t capacity = 1024;
  struct Place {
    double s, x;
  };
  std::array<Place, capacity> places_{};
  /// The side of each bound is kept apart, because a bool next to two doubles would take eight
  /// bytes.
  std::bitset<capacity> below_;
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace kinalign
