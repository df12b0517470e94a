// SPDX-License-Identifier: Apache-2.0
// One instant of a skeleton, and a motion that can be asked for it at any time.
#pragma once

#include "kinalign/motion/clip.h"

#include <functional>
#include <vector>

namespace kinalign {

/// Each joint in its parent's space, as a frame of a clip has it.
struct Pose {
  std::vector<Vec3> local_positions;  // [J] m
  std::vector<Quat> local_rotations;  // [J] unit
};

/// Each joint in the space of the roots.
struct GlobalPose {
  std::vector<Vec3> positions;  // [J] m
  std::vector<Quat> rotations;  // [J] unit
};

/// Fills `global`, whatever stood in it.
void forward_kinematics(const Skeleton& skeleton, const Pose& local, GlobalPose& global);

/// A skeleton that moves, as a function of time: clips of any rate, cameras and inertial nodes are
/// all taken of the same one. Each joint's place and rotation are at least twice continuously
/// differentiable within [0, length_s]. pose_at may be called from several threads.
struct Motion {
  Skeleton skeleton;
  double length_s = 0.0;
  /// Fills the pose at a time, s; outside [0, length_s] it goes on without a meaning of its own.
  std::function<void(double t, Pose& pose)> pose_at;
};

/// Frames at t = k / rate_hz for all k that lie within the motion; `first` is the stamp of t = 0.
ClipFrames sample_frames(const Motion& motion, double rate_hz, Time first);

}  // namespace kinalign
