// SPDX-License-Identifier: Apache-2.0
// The bounds of the last exchanges of a piece, as they came: after a step of the counter they tell
// how far back stamps are in doubt.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <optional>

namespace kinalign {

enum class Bound : bool { above, below };

struct JournalEntry {
  double s = 0.0, x = 0.0;
  Bound bound = Bound::above;
};

class ExchangeJournal {
 public:
  void add(const JournalEntry& entry);
  std::size_t size() const { return size_; }
  JournalEntry newest(std::size_t i) const;  // 0: the last one

 private:
  static constexpr std::size_t capacity = 1024;
  struct Place {
    double s, x;
  };
  std::array<Place, capacity> places_{};
  std::bitset<capacity> below_;
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace kinalign
