// SPDX-License-Identifier: Apache-2.0
// The likeliest offset at any time of a piece. Each route is fitted to all its bounds. The routes
// are joined, because the offset is continuous. A piece is a stretch of time in which one model of
// the clock is valid; a route is the path of the packets (docs/clock.md).
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/live/route.h"

#include <cstddef>
#include <vector>

namespace kinalign {

class OfflineEstimate {
 public:
  /// `bounds` must be in the order in which the live clock got them.
  explicit OfflineEstimate(const std::vector<Bound>& bounds);

  /// Returns x(t). The call is fastest if t rises from call to call. Needs a bound of each kind.
  double at(double t);
  std::size_t routes() const { return stretches_.size(); }
  double least_round_trip() const;  // s

 private:
  /// The lowest bounds of ten seconds. They show how well a floor is known around that time.
  struct Lows {
    std::vector<OffsetBound> above, below;
  };
  struct Stretch {
    double begin = 0.0, end = 0.0;
    Route route;
    std::vector<Lows> lows;
    Middle last;
    double moved = 0.0;  // shift that joins this route to the other routes
  };
  static void add(Stretch& stretch, const Bound& bound, double slope);
  static Middle middle(const Stretch& stretch, double t);
  void join();

  std::vector<Stretch> stretches_;
};

}  // namespace kinalign
