// SPDX-License-Identifier: Apache-2.0
// Stores the newest bounds of a piece (clock_piece.h) in their order of arrival. After a step of
// the counter, they tell from which time on stamps are doubtful.
#pragma once

#include "kinalign/clock/bound.h"

#include <array>
#include <bitset>
#include <cstddef>

namespace kinalign {

/// A ring buffer of fixed size, so that memory does not grow with the length of a recording.
class BoundJournal {
 public:
  void add(const Bound& bound);
  std::size_t size() const { return size_; }
  Bound newest(std::size_t i) const;  // 0: the newest bound

 private:
  static constexpr std::size_t capacity = 1024;
  struct Place {
    double s, x;
  };
  std::array<Place, capacity> places_{};
  /// The side of each bound is stored separately. A bool next to two doubles would take eight
  /// bytes.
  std::bitset<capacity> below_;
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace kinalign
