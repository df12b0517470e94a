// SPDX-License-Identifier: Apache-2.0
// Keeps crossings that contradict the certificate. Either such a packet is wrong or the counter
// stepped. If it is wrong, a later crossing contradicts it. If nothing contradicts it for a while,
// it is believed.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// One direction of an exchange. A frame that left at n and arrived at h bounds the offset from
/// above; a reply that left at h and arrived at n bounds it from below.
struct Crossing {
  Side side = Side::above;
  NodeTime n{};
  HostTime h{};
  HostTime arrival{};  // arrival of the frame that reported it
};

/// A crossing that contradicts the certificate.
struct Violator {
  Crossing crossing;
  Bound bound;
  double amount = 0.0;       // distance to the certificate, s
  std::uint64_t number = 0;  // its number among the crossings of the piece
};

/// True if no function with at most this rate satisfies both bounds.
bool contradict(const Bound& a, const Bound& b, double rate);

class Violators {
 public:
  /// For counters of 1 us on both sides and their reading.
  static constexpr double tolerated_s = 5e-6;
  static constexpr Duration wait = std::chrono::seconds(5);

  /// Call only while full() is false.
  void add(const Violator& violator);
  /// Drops the violators that contradict `taken`, a bound that agrees with the certificate and is
  /// more than a second later.
  void drop_excluded_by(const Bound& taken, double rate);
  void clear() { count_ = 0; }

  std::span<const Violator> pending() const { return {violators_.data(), count_}; }
  bool full() const { return count_ == violators_.size(); }
  /// True if a violator has been pending for so long that it must be believed.
  bool overdue(HostTime now, std::uint64_t crossings) const;

 private:
  std::array<Violator, 3> violators_{};
  std::size_t count_ = 0;
};

}  // namespace kinalign
