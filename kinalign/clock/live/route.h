// SPDX-License-Identifier: Apache-2.0
// The likeliest offset between two clocks while packets take one route.
#pragma once

#include "kinalign/clock/live/floor.h"

namespace kinalign {

/// What is known of a slope: a mean with a standard deviation. At first between what an ESP32's
/// crystal may be off at 25 C (+-10 ppm, Espressif's hardware guidelines) and uncompensated ones
/// are from 0 to 50 C (+-20 ppm; table 1 of "Time synchronisation for millisecond-precision on
/// bio-loggers", Movement Ecology 2024).
struct SlopeBelief {
  double mean = 0.0;
  double deviation = 15e-6;

  /// Of the same crystal behind a reboot or a step: it may have warmed meanwhile.
  SlopeBelief after_a_break() const { return {mean, deviation + 2e-6}; }
};

/// x(t) in the middle between two floors.
struct Middle {
  double t = 0.0;
  double value = 0.0;
  double slope = 0.0;
  double deviation = 0.0;                           // of the value if the floors are alike
  double round_trip = 0.0;                          // between the floors
  double above_density = 0.0, below_density = 0.0;  // 0: not known yet

  double at(double s) const { return value + slope * (s - t); }
  Middle moved_to(double s) const {
    Middle moved = *this;
    moved.t = s;
    moved.value = at(s);
    return moved;
  }
  FloorLine floor(Side side) const;  // mirrored below
  double density(Side side) const { return side == Side::above ? above_density : below_density; }
  bool sharp() const { return above_density > 0.0 && below_density > 0.0; }
  /// How far the two floors may still lie from where they are seen, s; 1 where they are not sharp.
  double floor_deviation() const;
};

/// Bounds from above (x <= h_rx - n_tx) and from below (x >= h_tx - n_rx) between which x runs as
/// long as the least delays stay what they are.
class Route {
 public:
  /// Remembers so many corners of each hull: few are enough while it is the newest end that is
  /// asked.
  explicit Route(SlopeBelief prior, std::size_t corners = 255)
      : prior_(prior), belief_(prior), above_(corners), below_(corners) {}

  void add(Side side, OffsetBound bound, const Middle& middle);
  bool bounded() const { return !above_.hull().empty() && !below_.hull().empty(); }
  const Floor& floor(Side side) const { return side == Side::above ? above_ : below_; }
  std::uint64_t points() const { return above_.counts().total() + below_.counts().total(); }
  SlopeBelief belief() const { return belief_; }

  /// Averaged over all slopes by how likely they are; `last` is an earlier answer or a guess. Needs
  /// a bound of each kind.
  Middle middle(double t, const Middle& last);
  /// At another t with the floors as sharp as they are for `now`.
  Middle middle_elsewhere(double t, const Middle& now) const;

 private:
  Middle average(double t, const Middle& known, SlopeBelief& around) const;

  SlopeBelief prior_, belief_;
  Floor above_, below_;
};

}  // namespace kinalign
