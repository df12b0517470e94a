// SPDX-License-Identifier: Apache-2.0
// Smoothness, delay and amplitude of a prediction, compared with the truth.
// Differences use only frames whose cells are all valid, without padding.
#pragma once

#include "kinalign/evaluate/sequence.h"

namespace kinalign {

/// The mean distance between the second differences of the prediction and of the truth, m/frame^2;
/// multiply by rate_hz^2 for m/s^2. Values at different rates must not be compared. Absent if no
/// joint is valid in three successive frames.
std::optional<double> acceleration_error(const Sequence& sequence, Prediction prediction);

/// The roughness of both motions over the same frames. True motion also has jitter, so the
/// predicted jitter is compared with the true one and not with 0.
struct Jitter {
  double predicted = 0.0, truth = 0.0;  // mean |third difference|, m/frame^3
  /// Below 0.7: over-smoothed; above 2: visibly shaky. Absent if the truth does not move.
  std::optional<double> ratio() const {
    return truth > 0.0 ? std::optional(predicted / truth) : std::nullopt;
  }
};
std::optional<Jitter> jitter(const Sequence& sequence, Prediction prediction);

/// The prediction's delay, s: the shift, up to `most_frames`, at which the joints' speeds correlate
/// best with the truth's. A parabola gives fractions of a frame. Absent if nothing moves or if the
/// best shift is at the end of the range.
std::optional<double> lag_s(const Sequence& sequence, Prediction prediction,
                            std::size_t most_frames = 15);

/// The standard deviation over time of the joints' distances from the root, divided by that of the
/// truth. Below 1 if the predicted motion is too small. Absent if the truth does not move.
std::optional<double> amplitude_ratio(const Sequence& sequence, Prediction prediction,
                                      std::size_t root);

}  // namespace kinalign
