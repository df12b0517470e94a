// SPDX-License-Identifier: Apache-2.0
// What goes with the pose: the same error each time the body is the same way.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

#include <array>

namespace kinalign {

/// A smooth random function of each joint's pose, of unit variance per axis over all poses
/// (correlation exp(-d^2 / 2 l^2) between poses d apart), correlated down the tree of joints: a sum
/// of waves, «random Fourier features» (Rahimi and Recht, NIPS 2007).
class KinectPoseError {
 public:
  /// `shared`: the share of the variance that cameras before one take have in common.
  KinectPoseError(const KinectIds& ids, double shared);

  /// [25], heading space, of poses [25,3] m.
  std::array<Vec3, kinect_joint_count> at(std::span<const double> poses) const;

 private:
  static constexpr std::size_t waves = 6;
  struct Wave {
    Vec3 along = Vec3::Zero();  // 1/m
    double phase = 0.0;
    Vec3 size = Vec3::Zero();
  };
  std::array<std::array<Wave, waves>, kinect_joint_count> waves_{};
};

}  // namespace kinalign
