// SPDX-License-Identifier: Apache-2.0
// Estimates the least delay of one direction of a route, from the fastest packets.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/lifted_hull.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// A straight line below the bounds of one direction: the bound of a packet with the least delay.
struct FloorLine {
  double s = 0.0, x = 0.0, slope = 0.0;

  double at(double t) const { return x + slope * (t - s); }
  double excess(OffsetBound bound) const { return bound.x - at(bound.s); }
};

/// Density of bounds just above a floor, in points per second of delay, from the nearest few of
/// these delays. Reorders `excess`. 0 for fewer than two.
double density_above(std::span<double> excess);

/// Histogram of the delays of a direction above its floor: classes grow by a factor of two, from 1
/// us on.
class ExcessCounts {
 public:
  void add(double excess);
  std::uint64_t total() const { return total_; }
  /// Number of delays above `excess`, counted in whole classes, so at least the true number.
  std::uint64_t above(double excess) const;
  /// The median of the delays, rounded up to a whole class.
  double median() const;

 private:
  std::array<std::uint32_t, 24> classes_{};
  std::uint64_t total_ = 0;
};

/// The bounds of one direction for as long as its floor does not change.
class Floor {
 public:
  explicit Floor(std::size_t corners) : hull_(usual_curvature, corners) {}

  void add(OffsetBound bound, const FloorLine& line);

  /// Density just above `line`, in points per second of delay: it tells how well the floor is
  /// known. 0 for fewer than two points.
  double density(const FloorLine& line) const;
  const LiftedHull& hull() const { return hull_; }
  const ExcessCounts& counts() const { return counts_; }

 private:
  void keep_low(OffsetBound bound, const FloorLine& line);

  /// The usual |x''|, not the greatest possible. With 1e-8 / s the error of each simulated link is
  /// the smallest, or within 15 % of it (docs/clock.md).
  static constexpr double usual_curvature = 1e-8;
  LiftedHull hull_;
  ExcessCounts counts_;
  std::array<OffsetBound, 12> low_{};  // points nearest to the floor in the last 100 s
  std::size_t lows_ = 0;
};

}  // namespace kinalign
