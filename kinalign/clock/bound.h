// SPDX-License-Identifier: Apache-2.0
// A bound on the offset x(s) = host minus node between two clocks (docs/clock.md). Each packet
// gives one upper or lower bound.
#pragma once

#include "kinalign/wire/time.h"

namespace kinalign {

/// Kind of a bound on x(s). A packet from the node to the host gives an upper bound (`above`); a
/// packet from the host to the node gives a lower bound (`below`).
enum class Side : bool { above, below };

/// States x(s) <= x or x(s) >= x. s and x are in seconds from an origin near the data.
struct Bound {
  double s = 0.0, x = 0.0;
  Side side = Side::above;
};

/// Zero of the seconds: one reading of each clock.
struct ClockOrigin {
  NodeTime node{};
  HostTime host{};
};

/// A counter is truncated to whole microseconds: the reading n stands for times from n to n + 1 us.
inline constexpr Duration counter_resolution = std::chrono::microseconds(1);
inline constexpr double counter_resolution_s = seconds(counter_resolution);

/// Converts `ns` to a duration. `ns` must already be rounded to an integer.
inline Duration nanoseconds(double ns) { return Duration{static_cast<std::int64_t>(ns)}; }

/// Returns the bound that follows from the readings n of the counter and h of the host clock.
inline Bound bound_by(const ClockOrigin& origin, Side side, NodeTime n, HostTime h) {
  const Duration node = n - origin.node;
  const Duration offset = (h - origin.host) - node;
  const double early = side == Side::below ? counter_resolution_s : 0.0;
  return {seconds(node), seconds(offset) - early, side};
}

/// An upper bound, x(s) <= x. A lower bound is stored with its sign changed, as -x(s) <= -x, so
/// that one algorithm works for both kinds.
struct OffsetBound {
  double s = 0.0;
  double x = 0.0;
};

constexpr OffsetBound from_above(const Bound& b) {
  return {b.s, b.side == Side::above ? b.x : -b.x};
}

}  // namespace kinalign
