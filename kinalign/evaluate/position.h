// SPDX-License-Identifier: Apache-2.0
// Errors of position (models.md 8.1 to 8.3).
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// Distances to the truth, m, of all valid cells, frame after frame.
std::vector<double> distances(const Sequence& sequence, Prediction prediction);

/// The same after each frame's root was put to the origin, on both sides. Frames whose root is not
/// valid drop out.
std::vector<double> root_aligned_distances(const Sequence& sequence, Prediction prediction,
                                           std::size_t root);

enum class Fit { rigid, similarity };

/// The same after a fit of each frame's valid joints onto the truth (Umeyama, PAMI 13(4), 1991).
/// Frames with fewer than `least_joints` (at least 4) drop out, and frames whose joints lie on one
/// line.
std::vector<double> fitted_distances(const Sequence& sequence, Prediction prediction, Fit fit,
                                     std::size_t least_joints = 4);

struct DistanceSummary {
  std::size_t cells = 0;
  double mean_m = 0.0, median_m = 0.0, percentile_95_m = 0.0;
};
/// Absent where there are no distances.
std::optional<DistanceSummary> summary_of(const std::vector<double>& distances);

/// PCK: the share of distances of at most `most_m`.
std::optional<double> share_within(const std::vector<double>& distances, double most_m);
/// The area under that share over 0 to `most_m`, divided by `most_m`: 1 where there is no error.
std::optional<double> area_under_share(const std::vector<double>& distances, double most_m = 0.15);

}  // namespace kinalign
