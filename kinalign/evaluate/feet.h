// SPDX-License-Identifier: Apache-2.0
// Feet on the floor (models.md 8.8).
#pragma once

#include "kinalign/evaluate/sequence.h"

namespace kinalign {

/// The conditions under which a true foot stands on the floor.
struct ContactOptions {
  double fastest_m_s = 0.15;  // of the step from the frame before
  double highest_m = 0.05;    // above the foot's floor: the lowest percentile of its height
  std::size_t least_frames = 3;
};

struct FeetMarks {
  std::size_t contacts = 0;  // frames and feet in contact
  double skate_m_s = 0.0;    // mean horizontal speed of the predicted foot in contact
  double true_skate_m_s = 0.0;
};
/// Absent where no foot is ever in contact.
std::optional<FeetMarks> feet_marks(const Sequence& sequence, Prediction prediction,
                                    std::span<const std::size_t> feet,
                                    const ContactOptions& options = {});

}  // namespace kinalign
