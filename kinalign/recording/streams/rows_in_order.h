// SPDX-License-Identifier: Apache-2.0
// Sorts rows that a network reordered by their stamps.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace kinalign {

/// A queue that releases a row only when `most_overtaking` later ones wait behind it. Rows leave in
/// the order of their stamps; equal stamps keep the order of arrival. Memory is limited by the
/// number of waiting rows.
template <class Row>
class RowsInOrder {
 public:
  /// `most_overtaking`: number of rows that wait for delayed ones.
  explicit RowsInOrder(std::size_t most_overtaking)
      : most_overtaking_(most_overtaking), wait_(most_overtaking) {}

  /// Adds a row. A row earlier than a row that was already taken is counted and left out.
  void add(Time stamp, Row row) {
    if (taken_ && stamp < *taken_) {
      ++too_late_;
      return;
    }
    waiting_.emplace(stamp, std::move(row));
  }
  /// Call after the last row. No row needs to wait any longer.
  void finish() { wait_ = 0; }
  /// Returns the earliest row. Absent if there is none, or if it must still wait.
  std::optional<std::pair<Time, Row>> take_first() {
    if (waiting_.size() <= wait_) return std::nullopt;
    auto first = waiting_.extract(waiting_.begin());
    taken_ = first.key();
    return std::pair(first.key(), std::move(first.mapped()));
  }

  std::size_t most_overtaking() const { return most_overtaking_; }
  std::uint64_t too_late() const { return too_late_; }

 private:
  std::size_t most_overtaking_, wait_;
  std::multimap<Time, Row> waiting_;
  std::optional<Time> taken_;  // stamp of the last taken row
  std::uint64_t too_late_ = 0;
};

}  // namespace kinalign
