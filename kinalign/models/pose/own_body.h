// SPDX-License-Identifier: Apache-2.0
// The bones of the person who is answered. Directions at rest stay those of the model's body, so
// that rotations keep their meaning: only lengths change.
#pragma once

#include "kinalign/models/pose/pose_body.h"

namespace kinalign {

/// m, thigh and shank of a body with the joints of pose_joints, the mean of both sides. Where the
/// trunk and the arms begin and end differs between skeletons; hips, knees and ankles do not.
double leg_length(const Skeleton& body);

/// m. The legs are 0.48 of it: 0.491 by Drillis and Contini (1966), 0.47 in a Perception Neuron.
double stature_of(const Skeleton& body);

/// All bones longer by one factor.
Skeleton scaled(Skeleton body, double factor);

/// Each bone as long as `own`'s, which has CMU's joints or a suit's (pose_skeleton.h). Fails where
/// joints are missing.
Result<Skeleton> with_lengths_of(Skeleton body, const Skeleton& own);

}  // namespace kinalign
