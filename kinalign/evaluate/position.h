// SPDX-License-Identifier: Apache-2.0
// Position errors of joints, with and without a rigid fit.
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// Distances to the truth, m, of all valid cells (frame, joint), frame after frame.
std::vector<double> distances(const Sequence& sequence, Prediction prediction);

/// The same distances after a similarity fit of each frame's valid joints onto the truth (Umeyama,
/// PAMI 13(4), 1991). Frames with fewer than `least_joints` (at least 4) valid joints, or with all
/// joints on one line, are left out.
std::vector<double> fitted_distances(const Sequence& sequence, Prediction prediction,
                                     std::size_t least_joints = 4);

}  // namespace kinalign
