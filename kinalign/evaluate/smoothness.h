// SPDX-License-Identifier: Apache-2.0
// Smoothness, delay and amplitude of a prediction against the truth's (models.md 8.5 to 8.7).
// Differences are taken over frames whose cells are all valid, without padding.
#pragma once

#include "kinalign/evaluate/sequence.h"

namespace kinalign {

/// Mean of |second difference - the truth's|, m/frame^2: times rate_hz^2 it is m/s^2. Never compare
/// across rates. Absent where no cell is valid in three frames on end.
std::optional<double> acceleration_error(const Sequence& sequence, Prediction prediction);

struct Jitter {
  double predicted = 0.0, truth = 0.0;  // mean |third difference|, m/frame^3
  /// Below 0.7 over-smoothed, above 2 visibly shaky; absent where the truth is at rest.
  std::optional<double> ratio() const {
    return truth > 0.0 ? std::optional(predicted / truth) : std::nullopt;
  }
};
std::optional<Jitter> jitter(const Sequence& sequence, Prediction prediction);

/// The prediction's delay, s: the shift within `most_frames` at which the joints' speeds correlate
/// best with the truth's, to a part of a frame by a parabola. Absent if nothing moves, or if the
/// best shift lies at the end of the range.
std::optional<double> lag_s(const Sequence& sequence, Prediction prediction,
                            std::size_t most_frames = 15);

/// The deviation over time of the joints' distances from the root, over the truth's: below 1 where
/// a method flattens motion. Absent where the truth is at rest.
std::optional<double> amplitude_ratio(const Sequence& sequence, Prediction prediction,
                                      std::size_t root);

}  // namespace kinalign
