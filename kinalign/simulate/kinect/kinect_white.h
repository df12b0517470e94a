// SPDX-License-Identifier: Apache-2.0
// Fast errors: independent from frame to frame, greater at higher speed of the joint, with heavy
// tails.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Adds white noise to `joints` [T,25,3] m.
/// Call after hold_bones(), which would take part of this noise away.
void add_white_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Adds twitches: the tracker reports a joint elsewhere for some frames.
void add_twitches(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// A draw of Student's t from two uniform numbers (Bailey, «Polar generation of random variates
/// with the t-distribution», Mathematics of Computation 62, 1994).
double student_t(double degrees, double u, double v);

}  // namespace kinalign
