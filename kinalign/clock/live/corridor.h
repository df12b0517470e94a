// SPDX-License-Identifier: Apache-2.0
// Upper and lower bounds on a function, and the values at t that they allow.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/lifted_hull.h"

#include <optional>

namespace kinalign {

/// Hulls of the bounds on x(s). `below` contains the lower bounds as upper bounds on -x.
struct Corridor {
  explicit Corridor(double rho, std::size_t corners = LiftedHull::all)
      : above(rho, corners), below(rho, corners) {}

  void add(const Bound& bound) {
    const OffsetBound b = from_above(bound);
    (bound.side == Side::above ? above : below).add(b.s, b.x);
  }

  LiftedHull above, below;
};

/// A line a + b (s - t) between the bounds.
struct CorridorLine {
  double above = 0.0, below = 0.0;  // the range of a for this slope
  double slope = 0.0;
  double width() const { return above - below; }
  double middle() const { return (above + below) / 2.0; }
};

/// Returns the line with a slope in [-beta, beta] for which the range of a is widest. If its width
/// is negative, no line fits.
CorridorLine widest_line(const Corridor& corridor, double t, double beta);

struct ValueRange {
  double low = 0.0, high = 0.0;
  double least_slope = 0.0, greatest_slope = 0.0;
};

/// Returns the range of x(t) for slopes in [-beta, beta]. `widest` is the result of widest_line().
/// Absent if bounds contradict each other. Needs a bound of each kind.
std::optional<ValueRange> value_range(const Corridor& corridor, double t, double beta,
                                      const CorridorLine& widest);

}  // namespace kinalign
