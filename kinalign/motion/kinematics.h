// SPDX-License-Identifier: Apache-2.0
// From joint angles to local rotations, and from local to global positions.
#pragma once

#include "kinalign/motion/clip.h"

#include <array>
#include <cstddef>
#include <span>

namespace kinalign {

/// Three elementary right-handed rotations, applied as R = R(first) R(second) R(third) to column
/// vectors (intrinsic, in this order). 0: about x, 1: y, 2: z.
struct EulerOrder {
  int first = 2, second = 0, third = 1;
};

/// Frames at a time for all joints, one after the other, that keep rows of channels in the first
/// cache: 0.6 of the time of whole columns of 256 frames.
constexpr std::size_t euler_frames = 16;

/// Angles of one joint over many frames, degrees, one column for each of the order's rotations
/// (nullptr: always zero), rows `stride` apart; rotations go to rotations[i * rotation_stride +
/// 0..3] as w,x,y,z. Angles up to 1e15; exact to 4e-16 a component up to 180 degrees.
struct EulerColumns {
  std::array<const double*, 3> angles{};
  std::size_t stride = 0;
  double* rotations = nullptr;
  std::size_t rotation_stride = 0;
};
void rotations_from_euler(const EulerOrder& order, const EulerColumns& columns, std::size_t frames);

/// Fills `global` [T,J,3] m: positions in the space of the roots; allocates nothing per frame.
void forward_kinematics(const Skeleton& skeleton, const ClipFrames& frames,
                        std::span<double> global);

}  // namespace kinalign
