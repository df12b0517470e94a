// SPDX-License-Identifier: Apache-2.0
// A queue for data that arrived after a given moment. It waits until marks that arrived earlier are
// processed. The data of one sender stays in order, although rounding may swap the arrival times of
// two of its messages.
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
  /// Returns whether the item must wait: it arrived after `until`, or an earlier item of its sender
  /// waits.
  bool must_hold(const Moment& came, std::uint64_t sender,
                 const std::optional<Moment>& until) const {
    return until && (is_behind(came, *until) || waiting_.contains(sender));
  }
  void hold(const Moment& came, std::uint64_t sender, Item item) {
    waiting_.insert(sender);
    held_.push_back({came, sender, std::move(item)});
  }
  std::size_t size() const { return held_.size(); }

  /// Passes on the items that need not wait for `until`. Without `until` it passes on all.
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
  std::set<std::uint64_t> waiting_;  // the senders of the items in held_
};

}  // namespace kinalign
