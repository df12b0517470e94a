// SPDX-License-Identifier: Apache-2.0
// Stores violators: crossings (packets in one direction) that contradict the certificate. Either
// the packet's stamp is wrong, or the counter stepped. A later crossing that contradicts the
// violator shows that the violator is wrong. If none does so for some time, the violator is taken
// as right.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// One packet of an exchange. A frame sent at n that arrived at h gives an upper bound of the
/// offset. A reply sent at h that arrived at n gives a lower bound.
struct Crossing {
  Side side = Side::above;
  NodeTime n{};
  HostTime h{};
  HostTime arrival{};  // arrival of the frame that contained these readings
};

/// A crossing that contradicts the certificate.
struct Violator {
  Crossing crossing;
  Bound bound;
  double amount = 0.0;       // distance to the certificate, s
  std::uint64_t number = 0;  // number of this crossing within the piece
};

/// Returns whether no function with at most this rate satisfies both bounds.
bool contradict(const Bound& a, const Bound& b, double rate);

class Violators {
 public:
  /// Tolerance for the resolution of both counters, 1 us, and for reading them.
  static constexpr double tolerated_s = 5e-6;
  static constexpr Duration wait = std::chrono::seconds(5);

  /// Call only while full() is false.
  void add(const Violator& violator);
  /// Removes the violators that contradict `taken`. `taken` agrees with the certificate and is more
  /// than a second later than these violators.
  void drop_excluded_by(const Bound& taken, double rate);
  void clear() { count_ = 0; }

  std::span<const Violator> pending() const { return {violators_.data(), count_}; }
  bool full() const { return count_ == violators_.size(); }
  /// Returns whether a violator has been pending so long that it is taken as right.
  bool overdue(HostTime now, std::uint64_t crossings) const;

 private:
  std::array<Violator, 3> violators_{};
  std::size_t count_ = 0;
};

}  // namespace kinalign
