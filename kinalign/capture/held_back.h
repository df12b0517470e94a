// SPDX-License-Identifier: Apache-2.0
// What arrived behind a moment, until marks that arrived before it have been obeyed. Of each sender
// it stays in order; arrivals on the host's axis are rounded, and two of one may seem swapped.
#pragma once

#include "kinalign/capture/host_clock.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace kinalign {

template <class Item>
class HeldBack {
 public:
  /// Whether what came then has to wait: behind `until`, or behind another of the same sender.
  bool must_hold(const Moment& came, std::uint64_t sender,
                 const std::optional<Moment>& until) const {
    return until && (is_behind(came, *until) || waits(held_, sender));
  }
  void hold(const Moment& came, std::uint64_t sender, Item item) {
    held_.push_back({came, sender, std::move(item)});
  }
  std::size_t size() const { return held_.size(); }

  /// Hands on what does not have to wait for `until`; without that all.
  template <class Take>
  void release(const std::optional<Moment>& until, Take take) {
    std::vector<Held> later;
    for (Held& held : std::exchange(held_, {})) {
      if (until && (is_behind(held.came, *until) || waits(later, held.sender))) {
        later.push_back(std::move(held));
      } else {
        take(held.item);
      }
    }
    held_ = std::move(later);
  }

 private:
  struct Held {
    Moment came;
    std::uint64_t sender = 0;
    Item item;
  };
  static bool waits(const std::vector<Held>& held, std::uint64_t sender) {
    return std::any_of(held.begin(), held.end(),
                       [sender](const Held& one) { return one.sender == sender; });
  }

  std::vector<Held> held_;
};

}  // namespace kinalign
