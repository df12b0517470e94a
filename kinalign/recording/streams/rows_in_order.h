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

/// A queue that releases the earliest row when `most_reordered` others wait behind it. Rows leave
/// in the order of their stamps; equal stamps keep the order of arrival. Memory is limited by the
/// number of waiting rows.
template <class Row>
class RowsInOrder {
 public:
  /// `most_reordered`: number of rows that wait for delayed ones.
  explicit RowsInOrder(std::size_t most_reordered) : most_reordered_(most_reordered) {}

  /// Adds a row and passes the earliest one to `release` if enough others wait. A row without a
  /// stamp, or earlier than a row that was already released, is counted and left out.
  template <class Release>
  void add(std::optional<Time> stamp, Row row, const Release& release) {
    if (!stamp) {
      ++unstamped_;
    } else if (released_ && *stamp < *released_) {
      ++too_late_;
    } else {
      waiting_.emplace(*stamp, std::move(row));
      if (waiting_.size() > most_reordered_) release_first(release);
    }
  }
  /// Call after the last row. Releases all rows.
  template <class Release>
  void finish(const Release& release) {
    while (!waiting_.empty()) release_first(release);
  }

  std::size_t most_reordered() const { return most_reordered_; }
  std::uint64_t too_late() const { return too_late_; }
  std::uint64_t unstamped() const { return unstamped_; }

 private:
  template <class Release>
  void release_first(const Release& release) {
    auto first = waiting_.extract(waiting_.begin());
    released_ = first.key();
    release(first.key(), std::move(first.mapped()));
  }

  std::size_t most_reordered_;
  std::multimap<Time, Row> waiting_;
  std::optional<Time> released_;  // stamp of the last released row
  std::uint64_t too_late_ = 0, unstamped_ = 0;
};

}  // namespace kinalign
