// SPDX-License-Identifier: Apache-2.0
// Exchanges left and right of legs, arms or the whole body for some tenths of a second, as the
// tracker does. This happens more often if the body is turned. A back may also be taken for a
// front.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Exchanges positions and states of both sides in `frames`. Call it last, because the positions
/// are exchanged with all their errors.
void exchange_sides(const KinectScene& scene, const KinectIds& ids, PointFrames& frames);

}  // namespace kinalign
