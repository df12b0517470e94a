// SPDX-License-Identifier: Apache-2.0
// The least delays of each ten seconds: what a user sees of the link, and the trace that a step of
// the counter leaves where it is too small for the certificate.
#pragma once

#include "kinalign/clock/live/corridor.h"
#include "kinalign/clock/live/route.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace kinalign {

/// Of one window of ten seconds that had six exchanges each way, or of several.
struct FloorWindow {
  double s = 0.0;           // its middle
  double middle = 0.0;      // of the offset, between the floors, s
  double round_trip = 0.0;  // s
  double gap = 0.0;         // how far the floors may lie from where they are seen, s
};

/// The shortest round trips of windows so far.
class ShortestRoundTrips {
 public:
  void add(const FloorWindow& window);
  /// Packets took this route, be it for two windows alone, and left it for another.
  void leave(const FloorWindow& route);
  /// What an interval of the certificate can't be narrower than, s: the least that three windows
  /// agree on, or that was left, less their noise. Up to two, in which a counter stepped, may show
  /// less than there is. 0: none.
  double least_width() const;

 private:
  struct RoundTrip {
    double s = 0.0, gap = 0.0;
  };
  std::array<RoundTrip, 8> shortest_{};  // rising
  std::size_t count_ = 0;
  std::optional<double> left_;  // the width of the shortest route that was left
};

class FloorLog {
 public:
  FloorLog() = default;
  /// Goes on with what earlier pieces of the node have shown.
  explicit FloorLog(const ShortestRoundTrips& shortest) : shortest_(shortest) {}

  /// `slope`: of the offset, as far as it is known.
  void add(const Bound& bound, const SlopeBelief& slope);
  /// The packets took another route from s on.
  void change_route(double s);

  static constexpr double window_s = 10.0;
  /// 0: the last whole window.
  std::optional<FloorWindow> window(std::size_t i) const;
  std::uint64_t windows() const { return windows_; }
  const ShortestRoundTrips& shortest() const { return shortest_; }
  /// What an interval can't be narrower than, s; 0 while that is in question: the last window shows
  /// nothing, or less, be it that a counter stepped in it or that the packets have found a shorter
  /// route. That three in a row show.
  double least_width() const;

  /// By how much the offset stepped within the windows before the last, if their round trips are
  /// alike on both sides: a route that is longer one way and as much shorter the other is unlikely.
  /// Single windows are compared over one between, and threes, whose floors are known better.
  std::optional<double> step() const { return step_; }
  static constexpr double longest_reach_s = 70.0;

 private:
  static constexpr std::size_t lowest = 6, remembered = 7;
  struct Lows {
    std::array<double, lowest> x{};  // rising, less the window's slope
    std::size_t count = 0;
  };
  void open(std::int64_t index, const SlopeBelief& slope);
  void close();
  std::optional<FloorWindow> merged(std::size_t first, std::size_t count) const;
  /// Of windows without a step: the offset's slope, and the usual round trip.
  struct Expected {
    SlopeBelief slope;
    double round_trip = 0.0;
  };
  /// How far offsets of windows usually differ, and whether these do by more.
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
  Corridor corridor_{0.0, corners};    // of the window's bounds, less its slope
  std::optional<std::int64_t> index_;  // absent: no window is open
  SlopeBelief slope_;                  // of the offset, when the window began
  std::array<std::optional<FloorWindow>, remembered> past_;
  std::uint64_t windows_ = 0;
  Comparison singles_, threes_;
  ShortestRoundTrips shortest_;
  std::optional<double> step_;
};

}  // namespace kinalign
