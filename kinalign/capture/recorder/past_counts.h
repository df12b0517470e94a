// SPDX-License-Identifier: Apache-2.0
// Counts that run on from take to take, remembered whenever a chunk is closed: a take begins with
// the chunks of its pre-roll, and its counts with what had come before them.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

namespace kinalign {

template <class Counts>
class PastCounts {
 public:
  /// What has come before chunk `number`. `first`: a take that began now would begin with that one.
  void remember(std::uint64_t number, std::uint64_t first, const Counts& counts) {
    past_.emplace_back(number, counts);
    while (past_.size() > 1 && past_[1].first <= first) past_.pop_front();
  }
  /// Before that chunk; none: nothing had come then.
  Counts before(std::uint64_t number) const {
    Counts counts{};
    for (const auto& [chunk, past] : past_) {
      if (chunk <= number) counts = past;
    }
    return counts;
  }

 private:
  std::deque<std::pair<std::uint64_t, Counts>> past_;
};

}  // namespace kinalign
