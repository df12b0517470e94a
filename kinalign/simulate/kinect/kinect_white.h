// SPDX-License-Identifier: Apache-2.0
// Fast errors: independent between frames, larger for faster joints, and with heavy tails.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Adds white noise to `joints` [T,25,3] m. Call after hold_bones(), which would remove a part of
/// this noise.
void add_white_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Adds twitches: for some frames the tracker reports a joint at another position.
void add_twitches(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Returns a draw of Student's t from two uniform numbers (Bailey, «Polar generation of random
/// variates with the t-distribution», Mathematics of Computation 62, 1994).
double student_t(double degrees, double u, double v);

}  // namespace kinalign
