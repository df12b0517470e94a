// SPDX-License-Identifier: Apache-2.0
// Crossings that the certificate excludes. Such a packet lies, or the counter stepped: if it lies,
// a later crossing can't go with it; what nothing speaks against for a while was true.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/wire/time.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// One way of an exchange: a frame that left at n and arrived at h bounds the offset from above, a
/// reply that left at h and arrived at n from below.
struct Crossing {
  Side side = Side::above;
  NodeTime n{};
  HostTime h{};
  HostTime heard{};  // when the frame arrived that told of it
};

struct Violator {
  Crossing crossing;
  Bound bound;
  double amount = 0.0;       // beyond the certificate, s
  std::uint64_t number = 0;  // of the crossings of its piece
};

/// Whether two bounds leave no way for a function of at most this rate.
bool contradict(const Bound& a, const Bound& b, double rate);

class Violators {
 public:
  static constexpr double tolerated_s = 5e-6;  // counters of 1 us, both ways, and what reads them
  static constexpr Duration wait = std::chrono::seconds(5);

  /// There must be room.
  void add(const Violator& violator);
  /// Drops those that a bound, of more than a second later, which the certificate takes can't go
  /// with.
  void drop_excluded_by(const Bound& taken, double rate);
  void clear() { count_ = 0; }

  std::span<const Violator> pending() const { return {violators_.data(), count_}; }
  bool full() const { return count_ == violators_.size(); }
  /// Whether one has been pending for so long that it is to be believed.
  bool overdue(HostTime now, std::uint64_t crossings) const;

 private:
  std::array<Violator, 3> violators_{};
  std::size_t count_ = 0;
};

}  // namespace kinalign
