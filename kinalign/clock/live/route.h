// SPDX-License-Identifier: Apache-2.0
// The likeliest offset between two clocks while packets take a single route.
#pragma once

#include "kinalign/clock/live/floor.h"

namespace kinalign {

/// Knowledge of a slope: mean and standard deviation. The default lies between the tolerance of an
/// ESP32's crystal at 25 C (+-10 ppm, Espressif's hardware guidelines) and that of uncompensated
/// crystals from 0 to 50 C (+-20 ppm; table 1 of "Time synchronisation for millisecond-precision on
/// bio-loggers", Movement Ecology 2024).
struct SlopeBelief {
  double mean = 0.0;
  double deviation = 15e-6;

  /// The belief about the same crystal after a reboot or a step: it may have warmed meanwhile.
  SlopeBelief after_a_break() const { return {mean, deviation + 2e-6}; }
};

/// x(t) in the middle between the two floors.
struct Middle {
  double t = 0.0;
  double value = 0.0;
  double slope = 0.0;
  double deviation = 0.0;   // sd of the value, if both floors have the same delay
  double round_trip = 0.0;  // distance between the floors, s
  /// Density of bounds at the floors; 0: not known yet.
  double above_density = 0.0, below_density = 0.0;

  double at(double s) const { return value + slope * (s - t); }
  Middle moved_to(double s) const {
    Middle moved = *this;
    moved.t = s;
    moved.value = at(s);
    return moved;
  }
  FloorLine floor(Side side) const;  // mirrored for the lower side
  double density(Side side) const { return side == Side::above ? above_density : below_density; }
  bool sharp() const { return above_density > 0.0 && below_density > 0.0; }
  /// Uncertainty of the two floors, s; 1 if they are not sharp.
  double floor_deviation() const;
};

/// Bounds from above (x <= h_rx - n_tx) and from below (x >= h_tx - n_rx). x lies between them as
/// long as the least delays don't change.
class Route {
 public:
  /// Keeps at most `corners` corners of each hull. A few are enough as long as only the newest end
  /// is asked for.
  explicit Route(SlopeBelief prior, std::size_t corners = 255)
      : prior_(prior), belief_(prior), above_(corners), below_(corners) {}

  void add(Side side, OffsetBound bound, const Middle& middle);
  bool bounded() const { return !above_.hull().empty() && !below_.hull().empty(); }
  const Floor& floor(Side side) const { return side == Side::above ? above_ : below_; }
  std::uint64_t points() const { return above_.counts().total() + below_.counts().total(); }
  SlopeBelief belief() const { return belief_; }

  /// The mean over all slopes, weighted by their likelihood. `last` is an earlier answer or a
  /// guess. Needs a bound of each kind.
  Middle middle(double t, const Middle& last);
  /// The middle at another t, with the floors as sharp as in `now`.
  Middle middle_elsewhere(double t, const Middle& now) const;

 private:
  Middle average(double t, const Middle& known, SlopeBelief& around) const;

  SlopeBelief prior_, belief_;
  Floor above_, below_;
};

}  // namespace kinalign
