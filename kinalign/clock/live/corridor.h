// SPDX-License-Identifier: Apache-2.0
// Between bounds from above and bounds from below: what they leave for a function's value at t.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/lifted_hull.h"

#include <optional>

namespace kinalign {

/// x(s) from above and below. The lower bounds are a hull of -x.
struct Corridor {
  explicit Corridor(double rho, std::size_t corners = LiftedHull::all)
      : above(rho, corners), below(rho, corners) {}

  void add(const Bound& bound) {
    const OffsetBound b = from_above(bound);
    (bound.side == Side::above ? above : below).add(b.s, b.x);
  }

  LiftedHull above, below;
};

/// A line a + b (s - t) through the corridor at t.
struct CorridorLine {
  double above = 0.0, below = 0.0;  // the ends that slope leaves for a
  double slope = 0.0;
  double width() const { return above - below; }
  double middle() const { return (above + below) / 2.0; }
};

/// The slope in [-beta, beta] that leaves the widest choice. Negative width: no line passes.
CorridorLine widest_line(const Corridor& corridor, double t, double beta);

struct ValueRange {
  double low = 0.0, high = 0.0;
  double least_slope = 0.0, greatest_slope = 0.0;
};

/// All that x(t) can be for any slope in [-beta, beta]; `widest` is widest_line's. Absent where
/// bounds contradict each other. Needs a bound of each kind.
std::optional<ValueRange> value_range(const Corridor& corridor, double t, double beta,
                                      const CorridorLine& widest);

}  // namespace kinalign
