// SPDX-License-Identifier: Apache-2.0
// How the tracker treats a joint that it can't see: it guesses the position, or it reports the
// object that hides the joint.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Reason why a joint is outside the image in a frame.
enum class Unseen : std::uint8_t { no, below_image, out_of_view };

/// Moves hidden joints of `frames`, positions [T,25,3] m, and sets their states [T,25] to inferred.
/// `unseen` [T,25]. Joints out of view are not changed; the caller handles them.
void guess_hidden(const KinectScene& scene, const KinectOptions& options, const KinectIds& ids,
                  std::span<const Unseen> unseen, PointFrames& frames);

}  // namespace kinalign
