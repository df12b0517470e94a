// SPDX-License-Identifier: Apache-2.0
// Rows out of a network, which lets some overtake others, in the order of their stamps.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

namespace kinalign {

template <class Row>
class RowsInOrder {
 public:
  /// `most_overtaking`: so many rows wait for those that they have overtaken.
  explicit RowsInOrder(std::size_t most_overtaking) : wait_(most_overtaking) {}

  void add(Time stamp, Row row) { waiting_.emplace(stamp, std::move(row)); }
  /// No more rows come: none has to wait.
  void finish() { wait_ = 0; }
  /// The earliest; absent where there is none, or it waits still.
  std::optional<std::pair<Time, Row>> take_first() {
    if (waiting_.size() <= wait_) return std::nullopt;
    auto first = waiting_.extract(waiting_.begin());
    return std::pair(first.key(), std::move(first.mapped()));
  }

 private:
  std::size_t wait_;
  std::multimap<Time, Row> waiting_;
};

}  // namespace kinalign
