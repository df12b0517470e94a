// SPDX-License-Identifier: Apache-2.0
// What arrived behind a moment, until marks that arrived before it have been obeyed. Of each sender
// it stays in order; arrivals on the host's axis are rounded, and two of one may seem swapped.
#pragma once

#include "kinalign/capture/net/host_clock.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace kinalign {

template <class Item>
class HeldBack {
 public:
  /// Whether what came then has to wait: behind `until`, or behind another of the same sender.
  bool must_hold(const Moment& came, std::uint64_t sender,
                 const std::optional<Moment>& until) const {
    return until && (is_behind(came, *until) || waiting_.contains(sender));
  }
  void hold(const Moment& came, std::uint64_t sender, Item item) {
    waiting_.insert(sender);
    held_.push_back({came, sender, std::move(item)});
  }
  std::size_t size() const { return held_.size(); }

  /// Hands on what does not have to wait for `until`; without that all.
  template <class Take>
  void release(const std::optional<Moment>& until, Take take) {
    waiting_.clear();
    for (Held& held : std::exchange(held_, {})) {
      if (must_hold(held.came, held.sender, until)) {
        hold(held.came, held.sender, std::move(held.item));
      } else {
        take(held.item);
      }
    }
  }

 private:
  struct Held {
    Moment came;
    std::uint64_t sender = 0;
    Item item;
  };
  std::vector<Held> held_;
  std::set<std::uint64_t> waiting_;  // their senders
};

}  // namespace kinalign
