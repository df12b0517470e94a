// SPDX-License-Identifier: Apache-2.0
// Exchanges of left and right: legs, arms or the whole body for some tenths of a second, more often
// the more the body is turned. Also a back that is taken for a front.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Exchanges joints and states of both sides in `frames`.
/// Call it last: it moves positions and states together, with all their errors.
void exchange_sides(const KinectScene& scene, const KinectIds& ids, PointFrames& frames);

}  // namespace kinalign
