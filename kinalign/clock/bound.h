// SPDX-License-Identifier: Apache-2.0
// What a packet says of the offset x(s) between two clocks: it is no more than this, or no less.
#pragma once

#include "kinalign/wire/time.h"

namespace kinalign {

/// Of x(s): a packet up, from the node to the host, bounds it from above, one down from below.
enum class Side : bool { above, below };

/// x(s) <= x, or >= x. Seconds from an origin near the data.
struct Bound {
  double s = 0.0, x = 0.0;
  Side side = Side::above;
};

/// Seconds are counted from this pair of readings.
struct ClockOrigin {
  NodeTime node{};
  HostTime host{};
};

/// A counter is cut to whole microseconds: a reading n stands for up to n + 1 us.
inline constexpr Duration counter_resolution = std::chrono::microseconds(1);
inline constexpr double counter_resolution_s = seconds(counter_resolution);

/// Of so many whole ones: who calls has rounded.
inline Duration nanoseconds(double ns) { return Duration{static_cast<std::int64_t>(ns)}; }

/// What it bounds that the counter read n and the host h.
inline Bound bound_by(const ClockOrigin& origin, Side side, NodeTime n, HostTime h) {
  const Duration node = n - origin.node;
  const Duration offset = (h - origin.host) - node;
  const double early = side == Side::below ? counter_resolution_s : 0.0;
  return {seconds(node), seconds(offset) - early, side};
}

/// A bound from above, x(s) <= x; of those from below the mirror image, -x(s) <= -x: what is done
/// with one kind is then done with both.
struct OffsetBound {
  double s = 0.0;
  double x = 0.0;
};

constexpr OffsetBound from_above(const Bound& b) {
  return {b.s, b.side == Side::above ? b.x : -b.x};
}

}  // namespace kinalign
