// SPDX-License-Identifier: Apache-2.0
// What the tracker does with a joint that it can't see: it guesses, or takes what hides it.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

namespace kinalign {

/// Why a joint is not seen in a frame.
enum class Unseen : std::uint8_t { no, below_image, out_of_view };

/// Moves `joints` [T,25,3] m that are hidden and marks `state` [T,25] inferred.
/// `unseen` [T,25]; out of view is left to who asks.
void guess_hidden(const KinectScene& scene, const KinectOptions& options, const KinectIds& ids,
                  std::span<const Unseen> unseen, PointFrames& frames);

}  // namespace kinalign
