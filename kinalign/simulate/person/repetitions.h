// SPDX-License-Identifier: Apache-2.0
// The repetitions of a slow movement: each has its own length, size and pause at its far end.
#pragma once

#include <cstdint>
#include <vector>

namespace kinalign {

/// One repetition: from rest to the far end, a pause there, and back to rest.
struct Repetition {
  double begin_s = 0.0, end_s = 0.0;
  double forth = 0.4, back = 0.4;  // shares of its length; the rest is the pause
  double amplitude = 1.0;          // 0.85 to 1.15
  double side = 1.0;               // +1: to the left, or with the left hand

  /// Share of the repetition that has passed, 0 to 1.
  double share(double t) const { return (t - begin_s) / (end_s - begin_s); }
  /// 0 at both ends, `amplitude` during the pause; three times continuously differentiable.
  double size(double t) const;
};

/// The period to fill, and the plan for it.
struct RepetitionPlan {
  double begin_s = 0.0, end_s = 0.0;
  double tempo_s = 5.0;      // mean length of a repetition
  double first_side = 1.0;   // sides alternate, beginning with this one
  std::uint64_t number = 0;  // number of the act, for the draws
};

/// Fills the period from its begin to its end, with at least one repetition. Lengths differ by up
/// to 20 % from their mean.
std::vector<Repetition> drawn_repetitions(const RepetitionPlan& plan, std::uint64_t seed);

/// The repetition at a time. At a border it is the later one; outside of all, the nearest. `all`
/// must not be empty.
const Repetition& repetition_at(const std::vector<Repetition>& all, double t);

}  // namespace kinalign
