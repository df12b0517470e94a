// SPDX-License-Identifier: Apache-2.0
// A queue of at most 64 events. Further events are counted but not kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kinalign {

/// The limit keeps memory bounded if the caller never takes the events.
template <class Event>
class EventQueue {
 public:
  // Events kept between two calls of take().
  static constexpr std::size_t most = 64;

  void add(const Event& event) {
    if (events_.size() < most) {
      events_.push_back(event);
    } else {
      ++missed_;
    }
  }
  /// Returns the events since the previous call.
  std::vector<Event> take() { return std::exchange(events_, {}); }
  /// Number of events that were not kept, because the queue was full.
  std::uint64_t missed() const { return missed_; }

 private:
  std::vector<Event> events_;
  std::uint64_t missed_ = 0;
};

}  // namespace kinalign
