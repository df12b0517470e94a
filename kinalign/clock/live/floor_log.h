// SPDX-License-Identifier: Apache-2.0
// Records the least delays of each ten seconds. They show the user the state of the link, and they
// reveal a step of the counter that is too small for the certificate.
#pragma once

#include "kinalign/clock/live/corridor.h"
#include "kinalign/clock/live/route.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// One window of ten seconds that had at least six exchanges each way, or several windows together.
struct FloorWindow {
  double s = 0.0;           // middle of the window
  double middle = 0.0;      // offset in the middle between the floors, s
  double round_trip = 0.0;  // s
  double gap = 0.0;         // uncertainty of the floors, s
};

/// The shortest round trips of all windows so far.
class ShortestRoundTrips {
 public:
  void add(const FloorWindow& window);
  /// Call when packets leave this route for another, even if they used it for two windows only.
  void leave(const FloorWindow& route);
  /// Lower limit for the width of a certified interval, s: the least round trip on which three
  /// windows agree, or that of a route that was left, minus its noise. Up to two windows, in which
  /// a counter stepped, may show less than the truth. 0: unknown.
  double least_width() const;

 private:
  struct RoundTrip {
    double s = 0.0, gap = 0.0;
  };
  std::array<RoundTrip, 8> shortest_{};  // in rising order
  std::size_t count_ = 0;
  std::optional<double> left_;  // width of the shortest route that packets left
};

class FloorLog {
 public:
  FloorLog() = default;
  /// Continues with the round trips from earlier pieces of the node.
  explicit FloorLog(const ShortestRoundTrips& shortest) : shortest_(shortest) {}

  /// `slope`: the slope of the offset, as far as it is known.
  void add(const Bound& bound, const SlopeBelief& slope);
  /// Call when the packets took another route from s on.
  void change_route(double s);

  static constexpr double window_s = 10.0;
  /// Window i; 0: the latest complete one.
  std::optional<FloorWindow> window(std::size_t i) const;
  std::uint64_t windows() const { return windows_; }
  const ShortestRoundTrips& shortest() const { return shortest_; }
  /// Lower limit for the width of an interval, s. It is 0 while it is in question: the last window
  /// has no round trip or a shorter one. A counter may have stepped in it, or the packets may have
  /// found a shorter route; three such windows in a row confirm the route.
  double least_width() const;

  /// Step of the offset within the windows before the last, if their round trips are alike on both
  /// sides. It is unlikely that a route gets longer one way and equally shorter the other way.
  /// Compares single windows across one window, and groups of three, whose floors are better known.
  std::optional<double> step() const { return step_; }
  static constexpr double longest_reach_s = 70.0;

 private:
  static constexpr std::size_t lowest = 6, remembered = 7;
  struct Lows {
    std::array<double, lowest> x{};  // in rising order, with the window's slope removed
    std::size_t count = 0;
  };
  void open(std::int64_t index, const SlopeBelief& slope);
  void close();
  std::optional<FloorWindow> merged(std::size_t first, std::size_t count) const;
  /// Values expected of windows without a step: the offset's slope and the usual round trip.
  struct Expected {
    SlopeBelief slope;
    double round_trip = 0.0;
  };
  /// The usual differences between the offsets of windows, and a test for greater ones.
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
  Corridor corridor_{0.0, corners};    // the window's bounds, with its slope removed
  std::optional<std::int64_t> index_;  // absent: no window is open
  SlopeBelief slope_;                  // slope of the offset at the start of the window
  std::array<std::optional<FloorWindow>, remembered> past_;
  std::uint64_t windows_ = 0;
  Comparison singles_, threes_;
  ShortestRoundTrips shortest_;
  std::optional<double> step_;
};

}  // namespace kinalign
