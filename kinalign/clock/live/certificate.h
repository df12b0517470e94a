// SPDX-License-Identifier: Apache-2.0
// Computes the interval that contains the offset between two clocks under stated assumptions
// (assumptions.h), from all exchanges so far. Hulls under straight lines come from Zhang, Liu and
// Xia (INFOCOM 2002) and from Harrison and Newman («TICSync», ICRA 2011). Lifting the hulls by the
// curvature (lifted_hull.h) is new here.
#pragma once

#include "kinalign/clock/assumptions.h"
#include "kinalign/clock/live/corridor.h"

#include <cstdint>
#include <optional>

namespace kinalign {

class Certificate {
 public:
  /// Keeps at most `corners` corners of each hull.
  explicit Certificate(const Assumptions& assumptions, std::size_t corners = LiftedHull::all)
      : assumptions_(assumptions), corridor_(assumptions.curvature, corners) {}

  void add(const Bound& bound);

  /// Returns whether there are enough bounds for a certificate: two upper bounds and one lower
  /// bound.
  bool bounded() const { return up_ >= 2 && down_ >= 1; }
  /// The range of all possible values of x(t). Absent if all bounds are of one kind, or if they
  /// contradict each other.
  std::optional<ValueRange> at(double t) const;
  const Assumptions& assumptions() const { return assumptions_; }
  /// Returns the same certificate for a greater curvature, computed from the corners of the hulls.
  Certificate relaxed(double curvature) const;

 private:
  Assumptions assumptions_;
  Corridor corridor_;
  std::uint64_t up_ = 0, down_ = 0;
};

}  // namespace kinalign
