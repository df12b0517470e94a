// SPDX-License-Identifier: Apache-2.0
// The interval that holds the offset between two clocks under stated assumptions (assumptions.h),
// from all exchanges so far. Hulls under straight lines are Zhang, Liu, Xia's (INFOCOM 2002) and
// Harrison and Newman's («TICSync», ICRA 2011); lifting them by the curvature is ours.
#pragma once

#include "kinalign/clock/assumptions.h"
#include "kinalign/clock/live/corridor.h"

#include <cstdint>
#include <optional>

namespace kinalign {

class Certificate {
 public:
  /// Remembers so many corners of each hull (lifted_hull.h).
  explicit Certificate(const Assumptions& assumptions, std::size_t corners = LiftedHull::all)
      : assumptions_(assumptions), corridor_(assumptions.curvature, corners) {}

  void add(const Bound& bound);

  /// There are bounds enough for a claim: two up, one down.
  bool bounded() const { return up_ >= 2 && down_ >= 1; }
  /// All that x(t) can be. Absent where there are no bounds of one kind, or where they contradict
  /// each other.
  std::optional<ValueRange> at(double t) const;
  const Assumptions& assumptions() const { return assumptions_; }
  /// The same under a greater curvature, from the corners of the hulls alone.
  Certificate relaxed(double curvature) const;

 private:
  Assumptions assumptions_;
  Corridor corridor_;
  std::uint64_t up_ = 0, down_ = 0;
};

}  // namespace kinalign
