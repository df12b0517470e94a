// SPDX-License-Identifier: Apache-2.0
// Errors of position (models.md 8.1 to 8.3).
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// Distances to the truth, m, of all valid cells, frame after frame.
std::vector<double> distances(const Sequence& sequence, Prediction prediction);

/// The same after a similarity fit of each frame's valid joints onto the truth (Umeyama, PAMI
/// 13(4), 1991). Frames with fewer than `least_joints` (at least 4) drop out, and frames whose
/// joints lie on one line.
std::vector<double> fitted_distances(const Sequence& sequence, Prediction prediction,
                                     std::size_t least_joints = 4);

}  // namespace kinalign
