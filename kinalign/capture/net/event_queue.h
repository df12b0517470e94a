// SPDX-License-Identifier: Apache-2.0
// What happened, kept until somebody asks: so many and no more, the rest is counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kinalign {

template <class Event>
class EventQueue {
 public:
  static constexpr std::size_t most = 64;

  void add(const Event& event) {
    if (events_.size() < most) {
      events_.push_back(event);
    } else {
      ++missed_;
    }
  }
  /// Since this was asked last.
  std::vector<Event> take() { return std::exchange(events_, {}); }
  std::uint64_t missed() const { return missed_; }

 private:
  std::vector<Event> events_;
  std::uint64_t missed_ = 0;
};

}  // namespace kinalign
