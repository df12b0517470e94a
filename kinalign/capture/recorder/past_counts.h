// SPDX-License-Identifier: Apache-2.0
// Counts that continue from take to take. Their values are stored whenever a chunk is closed. A
// take begins with the chunks of its pre-roll, so its counts begin with the values before these
// chunks.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

namespace kinalign {

/// It keeps one value for each chunk with which a take may begin.
template <class Counts>
class PastCounts {
 public:
  /// Stores the counts before chunk `number`. `first`: the first chunk of a take that would begin
  /// now; older values are discarded.
  void remember(std::uint64_t number, std::uint64_t first, const Counts& counts) {
    past_.emplace_back(number, counts);
    while (past_.size() > 1 && past_[1].first <= first) past_.pop_front();
  }
  /// The counts before that chunk. All are zero if nothing was stored.
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
