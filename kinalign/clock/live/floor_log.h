// SPDX-License-Identifier: Apache-2.0
// Records the floors (least delays) of windows of ten seconds. They show the state of the link.
// They also reveal a step of the counter that is too small to contradict the certificate.
#pragma once

#include "kinalign/clock/live/corridor.h"
#include "kinalign/clock/live/route.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// One window of ten seconds with at least six exchanges in each direction, or several such windows
/// combined.
struct FloorWindow {
  double s = 0.0;           // middle of the window
  double middle = 0.0;      // offset midway between the floors, s
  double round_trip = 0.0;  // s
  double gap = 0.0;         // uncertainty of the floors, s
};

/// The shortest round trips in all windows so far.
class ShortestRoundTrips {
 public:
  void add(const FloorWindow& window);
  /// Call when packets change from this route to another, even if only two windows used this route.
  void leave(const FloorWindow& route);
  /// Returns the least possible width of a certified interval, s; 0: unknown. It is the shortest
  /// round trip that three windows confirm, or the round trip of an earlier route, minus its noise.
  /// A counter step can make the round trips of up to two windows too short.
  double least_width() const;

 private:
  struct RoundTrip {
    double s = 0.0, gap = 0.0;
  };
  std::array<RoundTrip, 8> shortest_{};  // in rising order
  std::size_t count_ = 0;
  std::optional<double> left_;  // width of the shortest earlier route
};

class FloorLog {
 public:
  FloorLog() = default;
  /// Begins with the shortest round trips of the node's earlier pieces.
  explicit FloorLog(const ShortestRoundTrips& shortest) : shortest_(shortest) {}

  /// `slope`: the slope of the offset, known from earlier bounds.
  void add(const Bound& bound, const SlopeBelief& slope);
  /// Call when the packets take another route from s on.
  void change_route(double s);

  static constexpr double window_s = 10.0;
  /// Window i. Window 0 is the newest complete window.
  std::optional<FloorWindow> window(std::size_t i) const;
  std::uint64_t windows() const { return windows_; }
  const ShortestRoundTrips& shortest() const { return shortest_; }
  /// Returns the least possible width of an interval, s. It is 0 if the last window has no round
  /// trip or a shorter one. The reason may be a step of the counter or a shorter route. Three such
  /// windows in a row confirm the route.
  double least_width() const;

  /// The step of the offset within the windows before the last. It requires similar round trips
  /// before and after. A route that gets longer in one direction and equally shorter in the other
  /// is unlikely. The comparison uses single windows two apart, and groups of three windows, whose
  /// floors are better known.
  std::optional<double> step() const { return step_; }
  static constexpr double longest_reach_s = 70.0;

 private:
  static constexpr std::size_t lowest = 6, remembered = 7;
  struct Lows {
    std::array<double, lowest> x{};  // in rising order; the window's slope is subtracted
    std::size_t count = 0;
  };
  void open(std::int64_t index, const SlopeBelief& slope);
  void close();
  std::optional<FloorWindow> merged(std::size_t first, std::size_t count) const;
  /// Expected values for windows without a step: the offset's slope and the usual round trip.
  struct Expected {
    SlopeBelief slope;
    double round_trip = 0.0;
  };
  /// The usual differences between the offsets of windows. A greater difference is a step.
  struct Comparison {
    std::uint64_t pairs = 0;
    double moved_squares = 0.0;

    std::optional<double> step(const FloorWindow& now, const FloorWindow& then,
                               const Expected& expected);
  };

  double usual_round_trip() const;
  double middle_s() const { return (static_cast<double>(*index_) + 0.5) * window_s; }

  std::array<Lows, 2> now_;
  static constexpr std::size_t corners = 63;
  Corridor corridor_{0.0, corners};    // bounds of the window; its slope is subtracted
  std::optional<std::int64_t> index_;  // absent: no window is open
  SlopeBelief slope_;                  // slope of the offset at the start of the window
  std::array<std::optional<FloorWindow>, remembered> past_;
  std::uint64_t windows_ = 0;
  Comparison singles_, threes_;
  ShortestRoundTrips shortest_;
  std::optional<double> step_;
};

}  // namespace kinalign
