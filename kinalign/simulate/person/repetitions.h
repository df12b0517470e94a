// SPDX-License-Identifier: Apache-2.0
// The repetitions of a slow movement. Each has its own length, size, and pause at the turning
// point.
#pragma once

#include <cstdint>
#include <vector>

namespace kinalign {

/// One repetition: a movement from rest to the turning point, a pause, and the movement back.
struct Repetition {
  double begin_s = 0.0, end_s = 0.0;
  double forth = 0.4, back = 0.4;  // shares of the length; the rest is the pause
  double amplitude = 1.0;          // 0.85 to 1.15
  double side = 1.0;               // +1: to the left or with the left hand

  /// Returns the share of the repetition that has passed, 0 to 1.
  double share(double t) const { return (t - begin_s) / (end_s - begin_s); }
  /// Returns the size of the movement: 0 at both ends, `amplitude` during the pause; three times
  /// continuously differentiable.
  double size(double t) const;
};

/// The time to fill with repetitions, and their properties.
struct RepetitionPlan {
  double begin_s = 0.0, end_s = 0.0;
  double tempo_s = 5.0;      // mean length of a repetition
  double first_side = 1.0;   // side of the first repetition; the sides alternate
  std::uint64_t number = 0;  // number of the act, which selects the random numbers
};

/// Fills the time with repetitions, at least one. Lengths differ from their mean by up to 20 %.
std::vector<Repetition> drawn_repetitions(const RepetitionPlan& plan, std::uint64_t seed);

/// Returns the repetition at a time. At a boundary it is the later repetition; outside all
/// repetitions it is the nearest. `all` must not be empty.
const Repetition& repetition_at(const std::vector<Repetition>& all, double t);

}  // namespace kinalign
