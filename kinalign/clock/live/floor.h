// SPDX-License-Identifier: Apache-2.0
// The least delay of one direction of one route, told from the fastest packets.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/lifted_hull.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// A straight floor under bounds.
struct FloorLine {
  double s = 0.0, x = 0.0, slope = 0.0;

  double at(double t) const { return x + slope * (t - s); }
  double excess(OffsetBound bound) const { return bound.x - at(bound.s); }
};

/// How densely bounds stand above a floor, in points per second of delay, by the nearest few of
/// these; they are put into another order. 0 with fewer than two.
double density_above(std::span<double> excess);

/// Where the delays of a direction lie above its floor: classes of a factor of two from 1 us on.
class ExcessCounts {
 public:
  void add(double excess);
  std::uint64_t total() const { return total_; }
  /// How many lie above, in whole classes: at least as many as do.
  std::uint64_t above(double excess) const;
  /// Half of them lie at most so far above, rounded up to a whole class.
  double median() const;

 private:
  std::array<std::uint32_t, 24> classes_{};
  std::uint64_t total_ = 0;
};

/// Bounds of one direction while its floor does not change.
class Floor {
 public:
  explicit Floor(std::size_t corners) : hull_(usual_curvature, corners) {}

  void add(OffsetBound bound, const FloorLine& line);

  /// Points per second of delay just above `line`: how sharply the floor is known. 0 with fewer
  /// than two points.
  double density(const FloorLine& line) const;
  const LiftedHull& hull() const { return hull_; }
  const ExcessCounts& counts() const { return counts_; }

 private:
  void keep_low(OffsetBound bound, const FloorLine& line);

  /// |x''| that is usual, not what can be: with 1e-8 / s each link's error is the least or within
  /// 15 % of it (docs/clock.md).
  static constexpr double usual_curvature = 1e-8;
  LiftedHull hull_;
  ExcessCounts counts_;
  std::array<OffsetBound, 12> low_{};  // the points nearest to the floor, of the last 100 s
  std::size_t lows_ = 0;
};

}  // namespace kinalign
