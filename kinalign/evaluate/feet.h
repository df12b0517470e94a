// SPDX-License-Identifier: Apache-2.0
// Foot skate: motion of feet that stand on the floor.
#pragma once

#include "kinalign/evaluate/sequence.h"

namespace kinalign {

/// The conditions under which a foot of the ground truth stands on the floor.
struct ContactOptions {
  double fastest_m_s = 0.15;     // speed since the previous frame
  double highest_m = 0.05;       // above the foot's floor: the 1 % quantile of its true heights
  std::size_t least_frames = 3;  // shorter contacts are ignored
};

/// Foot skate over all frames of contact. True feet move a little, too, so a method's skate is
/// compared with the true one and not with 0.
struct FeetMarks {
  std::size_t contacts = 0;  // frames in contact, summed over the feet
  double skate_m_s = 0.0;    // mean horizontal speed of predicted feet in contact
  double true_skate_m_s = 0.0;
};
/// Absent if no foot is ever in contact.
std::optional<FeetMarks> feet_marks(const Sequence& sequence, Prediction prediction,
                                    std::span<const std::size_t> feet,
                                    const ContactOptions& options = {});

}  // namespace kinalign
