// SPDX-License-Identifier: Apache-2.0
// Transfers a recorded motion to a body of perception_neuron.h. The bones of the limbs get the
// directions of the recorded bones. Trunk and head get the recorded rotations. The root gets the
// recorded path, scaled by the length of the legs, so the unit of length of the recording does not
// matter. Feet may slide by some centimetres, because the proportions of trunk and legs differ.
#pragma once

#include "kinalign/motion/pose.h"

namespace kinalign {

/// `body`: a skeleton made by perception_neuron(). The root begins at x = z = 0. In the source, y
/// must be up, and the rest pose must be a T-pose that faces +z. Fails if the joint names are not
/// those of Perception Neuron, of CMU files converted by cgspeed, or of CMU's own ASF files.
Result<Motion> carried_over(Motion source, Skeleton body);

/// Plays the motion from `begin_s` to `end_s`, slows down, plays it backwards, and repeats this
/// until `length_s`. A short motion thus lasts as long as needed, without a jump. It is never
/// faster than the original motion. Fails if the played part is shorter than 1 s.
Result<Motion> there_and_back(Motion motion, double begin_s, double end_s, double length_s);

}  // namespace kinalign
