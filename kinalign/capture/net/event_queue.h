// SPDX-License-Identifier: Apache-2.0
// A queue of events with a fixed limit. Events beyond the limit are only counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kinalign {

/// A caller that does not take its events must not make the program grow.
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
  /// Events since the previous call.
  std::vector<Event> take() { return std::exchange(events_, {}); }
  std::uint64_t missed() const { return missed_; }

 private:
  std::vector<Event> events_;
  std::uint64_t missed_ = 0;
};

}  // namespace kinalign
