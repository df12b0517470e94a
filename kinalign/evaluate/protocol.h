// SPDX-License-Identifier: Apache-2.0
// The measures of UI-PRMD's protocol (docs/models.md), in its units.
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// The measures of one repetition. A measure is absent if no valid frames exist for it.
struct ProtocolMarks {
  std::optional<double> position_cm;  // MPJPE: mean distance of a joint from the truth
  /// PA-MPJPE: the position error after a similarity fit of each frame with at least 12 valid
  /// joints.
  std::optional<double> fitted_cm;
  std::optional<double> bone_cm;       // BONE: compared with the take's median true lengths
  std::optional<double> constancy_cm;  // CONST: variation of the bones' lengths
  double acceleration_mm = 0.0;        // ACC, mm/frame^2; 0 without valid frames
  double jitter_mm = 0.0, true_jitter_mm = 0.0;  // mm/frame^3; 0 without valid frames
};

/// `sequence` has the 18 shared joints (motion/shared_joints.h). `lengths_m` of the 11 limb bones
/// are those of the whole take (limb_lengths), not of the repetition.
ProtocolMarks protocol_marks(const Sequence& sequence, Prediction prediction,
                             std::span<const std::optional<double>> lengths_m);

/// The median true lengths of the limb bones over a take's repetitions, m.
std::vector<std::optional<double>> limb_lengths(std::span<const Sequence> take);

/// One row of a table: means over repetitions. JIT is the ratio of two such means.
struct ProtocolMeans {
  std::optional<double> position_cm, fitted_cm, bone_cm, constancy_cm;
  double acceleration_mm = 0.0;
  std::optional<double> jitter;  // ratio to the truth's jitter; absent if the truth does not move
};
ProtocolMeans protocol_row(std::span<const ProtocolMarks> repetitions);

}  // namespace kinalign
