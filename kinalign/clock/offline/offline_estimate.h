// SPDX-License-Identifier: Apache-2.0
// The likeliest offset at any time of a whole piece: each route by all of its bounds, the routes
// joined by what is continuous over their changes.
#pragma once

#include "kinalign/clock/bound.h"
#include "kinalign/clock/live/route.h"

#include <cstddef>
#include <vector>

namespace kinalign {

class OfflineEstimate {
 public:
  /// Bounds in the order in which they became known.
  explicit OfflineEstimate(const std::vector<Bound>& bounds);

  /// x(t); t nearly rising from call to call is fastest. Needs a bound of each kind.
  double at(double t);
  std::size_t routes() const { return stretches_.size(); }
  double least_round_trip() const;  // s

 private:
  /// The lowest bounds of ten seconds, by which a floor's sharpness is known around there.
  struct Lows {
    std::vector<OffsetBound> above, below;
  };
  struct Stretch {
    double begin = 0.0, end = 0.0;
    Route route;
    std::vector<Lows> lows;
    Middle last;
    double moved = 0.0;  // to join it to the others
  };
  static void add(Stretch& stretch, const Bound& bound, double slope);
  static Middle middle(const Stretch& stretch, double t);
  void join();

  std::vector<Stretch> stretches_;
};

}  // namespace kinalign
