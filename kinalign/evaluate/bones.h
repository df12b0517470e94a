// SPDX-License-Identifier: Apache-2.0
// Compares bone lengths with given lengths: BONE and CONST of UI-PRMD's protocol (docs/models.md).
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// The median true length of each bone over all sequences of a take, m. Absent if the two ends of
/// the bone were never valid together.
std::vector<std::optional<double>> median_lengths(std::span<const Sequence> take,
                                                  std::span<const Bone> bones);

/// The accuracy of a prediction's bone lengths. `error_m` needs known lengths; `constancy_m` is
/// computed from the prediction alone.
struct LengthMarks {
  double error_m = 0.0;      // mean over all frames and bones of |length - given|
  double constancy_m = 0.0;  // mean over bones of the length's standard deviation
};
/// Uses frames in which both ends of a bone are valid. Bones without a given length or with fewer
/// than five such frames are left out. Absent if no bone remains.
std::optional<LengthMarks> length_marks(const Sequence& sequence, Prediction prediction,
                                        std::span<const Bone> bones,
                                        std::span<const std::optional<double>> given);

}  // namespace kinalign
