// SPDX-License-Identifier: Apache-2.0
// The likeliest offset between two clocks while all packets take the same route. The floor of a
// direction is the least delay on the route (docs/clock.md).
#pragma once

#include "kinalign/clock/live/floor.h"

namespace kinalign {

/// Mean and standard deviation of a slope. The default deviation is between two values: the
/// tolerance of an ESP32's crystal at 25 C (+-10 ppm, Espressif's hardware guidelines) and that of
/// uncompensated crystals from 0 to 50 C (+-20 ppm; table 1 of "Time synchronisation for
/// millisecond-precision on bio-loggers", Movement Ecology 2024).
struct SlopeBelief {
  double mean = 0.0;
  double deviation = 15e-6;

  /// The slope of the same crystal after a reboot or a step. The crystal may have warmed.
  SlopeBelief after_a_break() const { return {mean, deviation + 2e-6}; }
};

/// The offset x(t) midway between the floors of both directions.
struct Middle {
  double t = 0.0;
  double value = 0.0;
  double slope = 0.0;
  double deviation = 0.0;   // standard deviation of the value, if both floors have the same delay
  double round_trip = 0.0;  // distance between the floors, s
  /// Density of bounds just above the floors; 0: not known.
  double above_density = 0.0, below_density = 0.0;

  double at(double s) const { return value + slope * (s - t); }
  Middle moved_to(double s) const {
    Middle moved = *this;
    moved.t = s;
    moved.value = at(s);
    return moved;
  }
  FloorLine floor(Side side) const;  // with changed sign for the lower side
  double density(Side side) const { return side == Side::above ? above_density : below_density; }
  bool sharp() const { return above_density > 0.0 && below_density > 0.0; }
  /// Uncertainty of the two floors, s; 1 if their densities are not known.
  double floor_deviation() const;
};

/// Upper bounds (x <= h_rx - n_tx) and lower bounds (x >= h_tx - n_rx) of one route. x lies between
/// them while the least delays don't change.
class Route {
 public:
  /// Keeps at most `corners` corners of each hull. If only the newest values are needed, a few
  /// corners suffice.
  explicit Route(SlopeBelief prior, std::size_t corners = 255)
      : prior_(prior), belief_(prior), above_(corners), below_(corners) {}

  void add(Side side, OffsetBound bound, const Middle& middle);
  bool bounded() const { return !above_.hull().empty() && !below_.hull().empty(); }
  const Floor& floor(Side side) const { return side == Side::above ? above_ : below_; }
  std::uint64_t points() const { return above_.counts().total() + below_.counts().total(); }
  SlopeBelief belief() const { return belief_; }

  /// Returns the mean over all slopes, weighted by their likelihood. `last` is an earlier result or
  /// a guess. Needs a bound of each kind.
  Middle middle(double t, const Middle& last);
  /// Returns the middle at another t, using the densities of `now`.
  Middle middle_elsewhere(double t, const Middle& now) const;

 private:
  Middle average(double t, const Middle& known, SlopeBelief& around) const;

  SlopeBelief prior_, belief_;
  Floor above_, below_;
};

}  // namespace kinalign
