// SPDX-License-Identifier: Apache-2.0
// Compares bone lengths with given lengths (UI-PRMD's protocol: BONE and CONST).
#pragma once

#include "kinalign/evaluate/sequence.h"

#include <vector>

namespace kinalign {

/// The median true length of each bone over all sequences of a take, m. Absent if the two ends of
/// the bone were never valid together.
std::vector<std::optional<double>> median_lengths(std::span<const Sequence> take,
                                                  std::span<const Bone> bones);

/// How well a prediction keeps its bones. The error needs known lengths; the constancy only
/// compares a prediction with itself.
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
