// SPDX-License-Identifier: Apache-2.0
// The likeliest offset between two clocks over changes of the packets' route. What a change of
// route does to the delays of each direction can't be told from them; but x(t) itself goes on
// without a jump, and so the offset is carried over from the route with the shortest round trip.
#pragma once

#include "kinalign/clock/live/recent_bounds.h"
#include "kinalign/clock/live/route.h"

#include <array>
#include <cstdint>
#include <optional>

namespace kinalign {

/// The moment when a route changed.
struct RouteChange {
  double s = 0.0;
  /// Known some seconds later. The round trip is what it was, to a hair, and the floors moved
  /// against each other by so much, s: then it was the counter that stepped. A route that is as
  /// much longer one way as it is shorter the other would look the same, which is unlikely.
  std::optional<double> step;
};

class OffsetEstimate {
 public:
  explicit OffsetEstimate(SlopeBelief prior = {}) : route_(prior) {}

  /// Nearly in order of s.
  void add(const Bound& bound);

  /// Absent until there is a bound of each kind.
  std::optional<Middle> at(double t);
  SlopeBelief slope() const { return route_.belief(); }
  /// Between the floors, of the shortest route so far, s.
  double least_round_trip() const;
  const std::optional<RouteChange>& last_change() const { return last_change_; }
  std::uint32_t changes() const { return changes_; }

 private:
  /// Where the present route was joined to the ones before.
  struct Joint {
    double s = 0.0, x = 0.0, variance = 0.0;
    double round_trip = 0.0, floor_deviation = 0.0;  // of the route before
    bool judged = false;                             // whether it was the counter that stepped
  };

  void add_to_route(Side side, OffsetBound bound);
  void look(double s, bool said);
  void refresh(double t);
  Middle joined(const Middle& middle) const;
  bool floors_known(double s) const;
  RecentBounds& recent(Side side) { return recent_[side == Side::above ? 0 : 1]; }
  void change_route(double s);
  void join_routes(double s);
  void guess_floors(double s, const Middle& before);
  void judge_change(double s);

  Route route_;
  Middle middle_;                // of the route alone; its lines are the floors
  std::uint32_t unseen_ = 0;     // bounds since then
  std::optional<double> since_;  // first bound of the route
  std::array<RecentBounds, 2> recent_;
  std::optional<Joint> joint_;
  double least_round_trip_ = 0.0;  // of the routes before
  std::optional<RouteChange> last_change_;
  std::uint32_t changes_ = 0;
};

}  // namespace kinalign
