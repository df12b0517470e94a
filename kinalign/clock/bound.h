// SPDX-License-Identifier: Apache-2.0
// A packet's statement about the offset x(s) between two clocks: an upper or a lower bound.
#pragma once

#include "kinalign/wire/time.h"

namespace kinalign {

/// Kind of bound on x(s). A packet up, from the node to the host, bounds it from above; one down
/// bounds it from below.
enum class Side : bool { above, below };

/// States x(s) <= x or x(s) >= x. Both in seconds from an origin near the data.
struct Bound {
  double s = 0.0, x = 0.0;
  Side side = Side::above;
};

/// Origin of the seconds: readings of both clocks.
struct ClockOrigin {
  NodeTime node{};
  HostTime host{};
};

/// A counter is truncated to whole microseconds: a reading n stands for times up to n + 1 us.
inline constexpr Duration counter_resolution = std::chrono::microseconds(1);
inline constexpr double counter_resolution_s = seconds(counter_resolution);

/// A duration of `ns` whole nanoseconds; the caller has rounded.
inline Duration nanoseconds(double ns) { return Duration{static_cast<std::int64_t>(ns)}; }

/// The bound that follows from readings n of the counter and h of the host.
inline Bound bound_by(const ClockOrigin& origin, Side side, NodeTime n, HostTime h) {
  const Duration node = n - origin.node;
  const Duration offset = (h - origin.host) - node;
  const double early = side == Side::below ? counter_resolution_s : 0.0;
  return {seconds(node), seconds(offset) - early, side};
}

/// An upper bound, x(s) <= x. A lower bound is stored mirrored, as -x(s) <= -x, so that one
/// algorithm serves both kinds.
struct OffsetBound {
  double s = 0.0;
  double x = 0.0;
};

constexpr OffsetBound from_above(const Bound& b) {
  return {b.s, b.side == Side::above ? b.x : -b.x};
}

}  // namespace kinalign
