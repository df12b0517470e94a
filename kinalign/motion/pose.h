// SPDX-License-Identifier: Apache-2.0
// A skeleton at one instant, and a motion that can be evaluated at any time.
#pragma once

#include "kinalign/motion/clip.h"

#include <functional>
#include <vector>

namespace kinalign {

/// The pose with each joint in its parent's space, as in a frame of a clip.
struct Pose {
  std::vector<Vec3> local_positions;  // [J] m
  std::vector<Quat> local_rotations;  // [J] unit
};

/// The pose with each joint in the space of the roots.
struct GlobalPose {
  std::vector<Vec3> positions;  // [J] m
  std::vector<Quat> rotations;  // [J] unit
};

/// Fills `global`; its earlier contents are replaced.
void forward_kinematics(const Skeleton& skeleton, const Pose& local, GlobalPose& global);

/// A moving skeleton as a function of time. Clips of any rate, cameras and inertial nodes can all
/// be simulated from the same motion. Position and rotation of each joint are at least twice
/// continuously differentiable within [0, length_s]. pose_at may be called from several threads.
struct Motion {
  Skeleton skeleton;
  double length_s = 0.0;
  /// Fills the pose at time `t`, s. Outside [0, length_s] it also fills a pose, but that pose has
  /// no defined meaning.
  std::function<void(double t, Pose& pose)> pose_at;
};

}  // namespace kinalign
