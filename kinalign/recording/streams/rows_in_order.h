// SPDX-License-Identifier: Apache-2.0
// Rows out of a network, which lets some overtake others, in the order of their stamps.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace kinalign {

template <class Row>
class RowsInOrder {
 public:
  /// `most_overtaking`: so many rows wait for those that they have overtaken.
  explicit RowsInOrder(std::size_t most_overtaking)
      : most_overtaking_(most_overtaking), wait_(most_overtaking) {}

  /// One that is earlier than a row that was taken already is counted and left out.
  void add(Time stamp, Row row) {
    if (taken_ && stamp < *taken_) {
      ++too_late_;
      return;
    }
    waiting_.emplace(stamp, std::move(row));
  }
  /// No more rows come: none has to wait.
  void finish() { wait_ = 0; }
  /// The earliest; absent where there is none, or it waits still.
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
  std::optional<Time> taken_;  // the last one's stamp
  std::uint64_t too_late_ = 0;
};

}  // namespace kinalign
