// SPDX-License-Identifier: Apache-2.0
// Constant errors of the joints: common to all people, of a person, of a take, and of a body that
// does not face the camera.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Adds the constant errors to `joints` [T,25,3] m.
void add_kinect_bias(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

}  // namespace kinalign
