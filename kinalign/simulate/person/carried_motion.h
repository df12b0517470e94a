// SPDX-License-Identifier: Apache-2.0
// Transfers a recorded motion to a body of perception_neuron.h. The bones of the limbs get the
// directions of the source's bones, trunk and head its rotations, and the root its path, scaled by
// the length of the legs. The source's unit of length therefore does not matter. Feet may slide by
// some centimetres, because trunk and legs have other proportions.
#pragma once

#include "kinalign/motion/pose.h"

namespace kinalign {

/// `body`: a skeleton made by perception_neuron(). The root begins at x = z = 0. The source must be
/// y up, with a T-pose that faces +z as rest pose. Fails if its joints are not named as Perception
/// Neuron's, as CMU's converted by cgspeed, or as CMU's own (ASF).
Result<Motion> carried_over(Motion source, Skeleton body);

/// Plays the motion from `begin_s` to `end_s`, slows down, plays it backwards, and so on until
/// `length_s`. It is never faster than the motion itself. Fails if that part is shorter than 1 s.
/// A short motion thus lasts as long as it is needed, without a jump.
Result<Motion> there_and_back(Motion motion, double begin_s, double end_s, double length_s);

}  // namespace kinalign
