// SPDX-License-Identifier: Apache-2.0
// The likeliest offset between two clocks, also if the packets change their route. Packets don't
// show how a change of route affects the delay in each direction. The true offset x(t) is
// continuous, so it is carried over from the route with the shortest round trip. The floor of a
// direction is the least delay on a route (docs/clock.md).
#pragma once

#include "kinalign/clock/live/recent_bounds.h"
#include "kinalign/clock/live/route.h"

#include <array>
#include <cstdint>
#include <optional>

namespace kinalign {

/// A change of route.
struct RouteChange {
  double s = 0.0;
  /// The step of the counter at this time, s; set some seconds after the change. It is set if the
  /// round trip is almost unchanged but the floors moved against each other. A route that is longer
  /// in one direction and equally shorter in the other would look the same, but is unlikely.
  std::optional<double> step;
};

class OffsetEstimate {
 public:
  explicit OffsetEstimate(SlopeBelief prior = {}) : route_(prior) {}

  /// Call nearly in the order of s.
  void add(const Bound& bound);

  /// The offset at t. It is absent until there is a bound of each kind.
  std::optional<Middle> at(double t);
  SlopeBelief slope() const { return route_.belief(); }
  /// Round trip of the shortest route so far, s.
  double least_round_trip() const;
  const std::optional<RouteChange>& last_change() const { return last_change_; }
  std::uint32_t changes() const { return changes_; }

 private:
  /// The moment at which the present route follows the earlier routes.
  struct Joint {
    double s = 0.0, x = 0.0, variance = 0.0;
    double round_trip = 0.0, floor_deviation = 0.0;  // values of the earlier route
    bool judged = false;  // judge_change() has looked for a step of the counter
  };

  void add_to_route(Side side, OffsetBound bound);
  void look(double s, bool is_informative);
  void refresh(double t);
  Middle joined(const Middle& middle) const;
  bool floors_known(double s) const;
  RecentBounds& recent(Side side) { return recent_[side == Side::above ? 0 : 1]; }
  void change_route(double s);
  void join_routes(double s);
  void guess_floors(double s, const Middle& before);
  void judge_change(double s);

  Route route_;
  Middle middle_;                // middle of the present route alone; contains its floors
  std::uint32_t unseen_ = 0;     // bounds since `middle_` was computed
  std::optional<double> since_;  // first bound of the route
  std::array<RecentBounds, 2> recent_;
  std::optional<Joint> joint_;
  double least_round_trip_ = 0.0;  // the least of the earlier routes
  std::optional<RouteChange> last_change_;
  std::uint32_t changes_ = 0;
};

}  // namespace kinalign
