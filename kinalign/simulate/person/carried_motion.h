// SPDX-License-Identifier: Apache-2.0
// A recorded motion carried over to a body of perception_neuron.h: the bones of the limbs point
// where the source's point, trunk and head turn as the source's do, and the root's path is scaled
// by the length of the legs. The source's unit of length therefore does not matter. Feet may slide
// by some centimetres, since trunk and legs have other proportions.
#pragma once

#include "kinalign/motion/pose.h"

namespace kinalign {

/// `body`: a skeleton that perception_neuron() made. The root begins at x = z = 0. The source is y
/// up, its rest pose a T-pose that faces +z. Fails where its joints are not named as Perception
/// Neuron's, CMU's as cgspeed converted them, or CMU's own (ASF).
Result<Motion> carried_over(Motion source, Skeleton body);

/// Goes through the motion from `begin_s` to `end_s`, slows down, goes back, and so on until
/// `length_s`; nowhere faster than the motion itself. Fails where that is less than 1 s of it.
Result<Motion> there_and_back(Motion motion, double begin_s, double end_s, double length_s);

}  // namespace kinalign
