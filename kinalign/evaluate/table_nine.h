// SPDX-License-Identifier: Apache-2.0
// The three columns of table 9 of the HFUT-MMD paper (README.md). The paper states no units, so the
// definitions are those in the code of its method BRA_DGN. Use the other measures of this room to
// judge methods: E_s does not depend on the truth, and a pose that never moves scores 0.
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// The three columns, in the unit of the positions. They exist only for comparison with the paper.
struct TableNine {
  double position = 0.0;  // E_p: mean square of a coordinate's error, unit^2
  double bone = 0.0;      // E_b: mean |length - true length|, unit
  double smooth = 0.0;    // E_s: roughness of the output itself, unit
  double true_smooth = 0.0;
};

/// The columns for one window [T,J,3] in any unit.
TableNine table_nine(std::span<const double> truth, Prediction prediction, std::size_t joints,
                     std::span<const Bone> bones);

/// The joints that define the position and heading of a skeleton.
struct OwnRootJoints {
  std::size_t root = 0;
  std::size_t hip_left = 0, hip_right = 0, shoulder_left = 0, shoulder_right = 0;
};
/// Moves each frame [T,J,3], in any unit, so that its root is at x = z = 0. Then rotates it about
/// y, so that its left side (hips and shoulders) points to +x. A frame without a direction is not
/// rotated.
std::vector<double> own_root(std::span<const double> positions, std::size_t joints,
                             const OwnRootJoints& own);

}  // namespace kinalign
