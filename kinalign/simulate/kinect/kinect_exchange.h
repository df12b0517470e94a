// SPDX-License-Identifier: Apache-2.0
// Left taken for right: legs, arms or the whole body for some tenths of a second, more often the
// more a body is turned; and a back that is taken for a front.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Exchanges joints and states of the two sides in `frames`.
void exchange_sides(const KinectScene& scene, const KinectIds& ids, PointFrames& frames);

}  // namespace kinalign
