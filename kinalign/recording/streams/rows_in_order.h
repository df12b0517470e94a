// SPDX-License-Identifier: Apache-2.0
// Sorts rows by their stamps, because a network may reorder them.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace kinalign {

/// A queue that releases the earliest row when `most_reordered` other rows wait. Rows leave in the
/// order of their stamps. Rows with equal stamps keep the order of arrival. The number of waiting
/// rows limits the memory.
template <class Row>
class RowsInOrder {
 public:
  /// `most_reordered`: the number of rows that wait for delayed rows.
  explicit RowsInOrder(std::size_t most_reordered) : most_reordered_(most_reordered) {}

  /// Adds a row. If enough rows wait, passes the earliest row to `release`. A row is left out and
  /// counted if it has no stamp, or if its stamp is earlier than that of a released row.
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
  /// Call this after the last row. It releases all waiting rows.
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
  std::optional<Time> released_;  // stamp of the row released last
  std::uint64_t too_late_ = 0, unstamped_ = 0;
};

}  // namespace kinalign
