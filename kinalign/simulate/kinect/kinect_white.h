// SPDX-License-Identifier: Apache-2.0
// What trembles: independent from frame to frame, more with a joint's speed, with heavy tails.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Adds to `joints` [T,25,3] m.
void add_white_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Adds, too: a joint that the tracker puts elsewhere for some frames and takes back.
void add_twitches(const KinectScene& scene, const KinectIds& ids, std::span<double> joints);

/// Student's t from two uniform numbers (Bailey, «Polar generation of random variates with the
/// t-distribution», Mathematics of Computation 62, 1994).
double student_t(double degrees, double u, double v);

}  // namespace kinalign
