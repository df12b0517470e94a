// SPDX-License-Identifier: Apache-2.0
// A clip of someone else's as a motion that can be asked at any time: positions by natural cubic
// splines, rotations by the rotation spline, both twice continuously differentiable, so that
// accelerations are finite and continuous.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/pose.h"

namespace kinalign {

struct ClipMotionOptions {
  /// Frames are first smoothed by a Gaussian of this deviation, s, 0 for none: what a suit's noise
  /// and a file's last decimal add to second derivatives grows with the square of the rate. 10 ms
  /// halve what moves at 19 Hz and leave 98 % at 3 Hz.
  double smooth_s = 0.01;
};

/// Time 0 is the first frame. Before it and behind the last, the nearest frame stands still. Memory
/// grows with the clip: 128 bytes a frame and joint. Fails on an invalid skeleton, without frames,
/// where arrays differ in length, stamps do not rise, or a number is not finite.
Result<Motion> motion_of(const Clip& clip, const ClipMotionOptions& options = {});

}  // namespace kinalign
