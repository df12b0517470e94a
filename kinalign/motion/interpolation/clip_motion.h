// SPDX-License-Identifier: Apache-2.0
// Turns a recorded clip into a motion that can be evaluated at any time: positions by natural cubic
// splines, rotations by the rotation spline. Both are twice continuously differentiable, so
// accelerations are finite and continuous.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/pose.h"

namespace kinalign {

struct ClipMotionOptions {
  /// Standard deviation of the Gaussian that smooths the frames first, s; 0: none. In second
  /// derivatives, a suit's noise and a file's rounding grow with the square of the frame rate. A
  /// deviation of 10 ms halves the amplitude of motion at 19 Hz and keeps 98 % of it at 3 Hz.
  double smooth_s = 0.01;
};

/// Time 0 is the first frame. Before the first and after the last frame the pose does not change.
/// Memory: 128 bytes per frame and joint. Fails if the skeleton is not valid, if there are no
/// frames, if arrays have wrong lengths, if stamps do not rise, or if a number is not finite.
Result<Motion> motion_of(const Clip& clip, const ClipMotionOptions& options = {});

}  // namespace kinalign
