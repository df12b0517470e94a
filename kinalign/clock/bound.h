// SPDX-License-Identifier: Apache-2.0
// What a packet says of the offset x(s) between two clocks: it is no more than this, or no less.
#pragma once

namespace kinalign {

/// Of x(s): a packet up, from the node to the host, bounds it from above, one down from below.
enum class Side : bool { above, below };

/// x(s) <= x, or >= x. Seconds from an origin near the data.
struct Bound {
  double s = 0.0, x = 0.0;
  Side side = Side::above;
};

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
