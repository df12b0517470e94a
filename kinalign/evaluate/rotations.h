// SPDX-License-Identifier: Apache-2.0
// Errors of rotation (models.md 8.9).
#pragma once

#include "kinalign/evaluate/sequence.h"

namespace kinalign {

/// T frames of J global rotations, w,x,y,z.
struct RotationSequence {
  std::size_t joints = 0;
  std::span<const double> truth;        // [T,J,4] unit
  std::span<const std::uint8_t> valid;  // [T,J]
};

/// Mean geodesic angle to the truth, rad, over the valid cells of the given joints. With hips and
/// shoulders it is the SIP error, with all joints the global angle. Absent where none is valid.
std::optional<double> rotation_error(const RotationSequence& sequence,
                                     std::span<const double> prediction,
                                     std::span<const std::size_t> joints);

/// Mean angle between the bones' directions, rad, for a truth of positions only.
std::optional<double> swing_error(const Sequence& sequence, Prediction prediction,
                                  std::span<const Bone> bones);

}  // namespace kinalign
