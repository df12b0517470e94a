// SPDX-License-Identifier: Apache-2.0
// The marks of UI-PRMD's protocol (kinect-noise-and-marks.md section 10), in its units.
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// The marks of one repetition. A mark is absent where no cell counts for it.
struct ProtocolMarks {
  std::optional<double> position_cm;   // MPJPE
  std::optional<double> fitted_cm;     // PA: a similarity per frame of 12 valid joints or more
  std::optional<double> bone_cm;       // BONE: against the take's median true lengths
  std::optional<double> constancy_cm;  // CONST
  double acceleration_mm = 0.0;        // ACC, mm/frame^2; 0 where no cell counts
  double jitter_mm = 0.0, true_jitter_mm = 0.0;  // mm/frame^3; 0 where no cell counts
};

/// `sequence` has the 18 shared joints (motion/shared_joints.h); `lengths_m` of the 11 limb bones
/// are the take's (limb_lengths), not the repetition's.
ProtocolMarks protocol_marks(const Sequence& sequence, Prediction prediction,
                             std::span<const std::optional<double>> lengths_m);

/// The median true lengths of the limb bones over a take's repetitions, m.
std::vector<std::optional<double>> limb_lengths(std::span<const Sequence> take);

/// A fold's row: means over repetitions; JIT is the ratio of the means.
struct ProtocolMeans {
  std::optional<double> position_cm, fitted_cm, bone_cm, constancy_cm;
  double acceleration_mm = 0.0;
  std::optional<double> jitter;  // times the truth's; absent where the truth is at rest
};
ProtocolMeans protocol_row(std::span<const ProtocolMarks> repetitions);

}  // namespace kinalign
