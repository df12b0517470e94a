// SPDX-License-Identifier: Apache-2.0
// Let g(b) = above(b) - below(b) be the width for the slope b. g is concave and piecewise linear.
// The peak of g is found by intersecting tangents, and the ends of the range g >= 0 by Newton steps
// from outside. Both methods are exact after finitely many steps.
#include "kinalign/clock/live/corridor.h"

#include <algorithm>
#include <cassert>

namespace kinalign {

namespace {

/// The width g and its derivative at a slope.
struct Gap {
  CorridorLine line;
  double rise = 0.0;
};

// The lower bounds are stored with changed sign, so their slope and their bound change sign here.
Gap gap_at(const Corridor& corridor, double t, double slope) {
  const auto up = corridor.above.at(t, slope);
  const auto down = corridor.below.at(t, -slope);
  return {{up.bound, -down.bound, slope}, down.tau - up.tau};
}

/// Returns the slope at which g becomes zero. The search begins at a slope `outside` and moves
/// towards the peak. With rounding errors the result stays outside.
double edge_from(const Corridor& corridor, double t, double outside) {
  for (;;) {
    const Gap gap = gap_at(corridor, t, outside);
    if (gap.line.width() >= 0.0 || gap.rise == 0.0) return outside;
    const double next = outside - gap.line.width() / gap.rise;
    if (next == outside) return outside;
    if ((next > outside) != (gap.rise > 0.0)) return outside;
    outside = next;
  }
}

}  // namespace

// If g falls from the left end on or rises up to the right end, this end is the peak. Otherwise the
// peak is between the ends, and tangents from both sides approach it.
CorridorLine widest_line(const Corridor& corridor, double t, double beta) {
  assert(!corridor.above.empty() && !corridor.below.empty());
  Gap left = gap_at(corridor, t, -beta);
  if (left.rise <= 0.0) return left.line;
  Gap right = gap_at(corridor, t, beta);
  if (right.rise >= 0.0) return right.line;
  for (;;) {
    // The tangents intersect at this slope. No point of g is above the tangents.
    const double slope = (right.line.width() - left.line.width() + left.rise * left.line.slope -
                          right.rise * right.line.slope) /
                         (left.rise - right.rise);
    if (slope <= left.line.slope) return left.line;
    if (slope >= right.line.slope) return right.line;
    const Gap gap = gap_at(corridor, t, slope);
    if (gap.rise == 0.0 || gap.rise == left.rise || gap.rise == right.rise) return gap.line;
    (gap.rise > 0.0 ? left : right) = gap;
  }
}

std::optional<ValueRange> value_range(const Corridor& corridor, double t, double beta,
                                      const CorridorLine& widest) {
  if (widest.width() < 0.0) return std::nullopt;
  ValueRange range;
  range.least_slope = std::min(edge_from(corridor, t, -beta), widest.slope);
  range.greatest_slope = std::max(edge_from(corridor, t, beta), widest.slope);
  // The limit of the range is concave in the slope. Its maximum is therefore at its own peak or at
  // an edge.
  const auto greatest = [&](const LiftedHull& hull, double least, double most) {
    const auto peak = hull.peak(t);
    return hull.at(t, std::clamp(peak.slope, least, most)).bound;
  };
  range.high = greatest(corridor.above, range.least_slope, range.greatest_slope);
  range.low = -greatest(corridor.below, -range.greatest_slope, -range.least_slope);
  return range;
}

}  // namespace kinalign
