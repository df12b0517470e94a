// SPDX-License-Identifier: Apache-2.0
// The tracker's behaviour for a joint that it can't see: it guesses the position, or takes the
// object that hides the joint.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Reason why a joint is not seen in a frame.
enum class Unseen : std::uint8_t { no, below_image, out_of_view };

/// Moves hidden joints of `frames`, positions [T,25,3] m, and marks their states [T,25] as
/// inferred. `unseen` [T,25]; joints out of view are left to the caller.
void guess_hidden(const KinectScene& scene, const KinectOptions& options, const KinectIds& ids,
                  std::span<const Unseen> unseen, PointFrames& frames);

}  // namespace kinalign
