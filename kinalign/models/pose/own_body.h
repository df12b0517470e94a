// SPDX-License-Identifier: Apache-2.0
// Adapts the model's body to a person's bone lengths. Rest directions stay those of the model's
// body, because the rotations refer to them.
#pragma once

#include "kinalign/models/pose/pose_body.h"

namespace kinalign {

/// Length of thigh plus shank, m, of a body with the joints of pose_joints, mean of both sides.
/// Skeletons place hips, knees and ankles alike but differ at trunk and arms, so only the legs are
/// measured.
double leg_length(const Skeleton& body);

/// Height of the person, m. Legs are 0.48 of it: 0.491 by Drillis and Contini (1966), 0.47 in a
/// Perception Neuron.
double stature_of(const Skeleton& body);

/// All bone lengths multiplied by one factor.
Skeleton scaled(Skeleton body, double factor);

/// Each bone gets its length in `own`, a skeleton with CMU's joints or those of a suit
/// (pose_skeleton.h). Fails if joints are missing.
Result<Skeleton> with_lengths_of(Skeleton body, const Skeleton& own);

}  // namespace kinalign
