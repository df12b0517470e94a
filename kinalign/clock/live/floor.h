// SPDX-License-Identifier: Apache-2.0
// Estimates the floor of one direction of a route: the least delay, known from the fastest packets.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/lifted_hull.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// A straight line below the bounds of one direction. A packet with the least delay gives a bound
/// on the line.
struct FloorLine {
  double s = 0.0, x = 0.0, slope = 0.0;

  double at(double t) const { return x + slope * (t - s); }
  double excess(OffsetBound bound) const { return bound.x - at(bound.s); }
};

/// Density of bounds just above a floor, in bounds per second of delay, from the smallest delays in
/// `excess`. Reorders `excess`. 0 for fewer than two delays.
double density_above(std::span<double> excess);

/// Histogram of the delays of one direction above its floor. Each class is twice as wide as the one
/// before, beginning with 1 us.
class ExcessCounts {
 public:
  void add(double excess);
  std::uint64_t total() const { return total_; }
  /// Number of delays above `excess`. Whole classes are counted, so the result may be too high.
  std::uint64_t above(double excess) const;
  /// The median of the delays, rounded up to a whole class.
  double median() const;

 private:
  std::array<std::uint32_t, 24> classes_{};
  std::uint64_t total_ = 0;
};

/// The bounds of one direction while its floor does not change.
class Floor {
 public:
  explicit Floor(std::size_t corners) : hull_(usual_curvature, corners) {}

  void add(OffsetBound bound, const FloorLine& line);

  /// Returns the density of bounds just above `line`, in bounds per second of delay. A high density
  /// means that the floor is well known. 0 for fewer than two bounds.
  double density(const FloorLine& line) const;
  const LiftedHull& hull() const { return hull_; }
  const ExcessCounts& counts() const { return counts_; }

 private:
  void keep_low(OffsetBound bound, const FloorLine& line);

  /// The usual |x''|, not the greatest possible one. With 1e-8 / s the error of each simulated link
  /// is the least or within 15 % of the least (docs/clock.md).
  static constexpr double usual_curvature = 1e-8;
  LiftedHull hull_;
  ExcessCounts counts_;
  std::array<OffsetBound, 12> low_{};  // lowest bounds of the last 100 s
  std::size_t lows_ = 0;
};

}  // namespace kinalign
