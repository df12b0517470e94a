// SPDX-License-Identifier: Apache-2.0
// The three columns of the paper's table 9, literally (models.md 2.6; definitions after BRA_DGN,
// the paper states no units). Judge methods by the other metrics: E_s has no truth in it, and a
// frozen pose scores 0.
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

struct TableNine {
  double position = 0.0;  // E_p: mean square of a coordinate's error, unit^2
  double bone = 0.0;      // E_b: mean |length - true length|, unit
  double smooth = 0.0;    // E_s: the output's own roughness, unit
  double true_smooth = 0.0;
};

/// The columns of one window [T,J,3] of any unit.
TableNine table_nine(std::span<const double> truth, Prediction prediction, std::size_t joints,
                     std::span<const Bone> bones);

/// The joints that say where a skeleton stands and looks.
struct OwnRootJoints {
  std::size_t root = 0;
  std::size_t hip_left = 0, hip_right = 0, shoulder_left = 0, shoulder_right = 0;
};
/// [T,J,3] of any unit: each frame moved so that its own root stands at x = z = 0, and turned about
/// y so that its own left (hips and shoulders) points to +x. A frame without a direction is not
/// turned.
std::vector<double> own_root(std::span<const double> positions, std::size_t joints,
                             const OwnRootJoints& own);

}  // namespace kinalign
