// SPDX-License-Identifier: Apache-2.0
// Errors that depend on the pose: the same pose of the body always has the same error.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

#include <array>

namespace kinalign {

/// A smooth random function of each joint's pose. For each axis, its variance over all poses is 1.
/// Poses at distance d have the correlation exp(-d^2 / 2 l^2). The functions are correlated along
/// the tree of joints. Each function is a sum of waves, «random Fourier features» (Rahimi and
/// Recht, NIPS 2007).
class KinectPoseError {
 public:
  /// `shared`: share of the variance that is the same for all cameras on a take.
  KinectPoseError(const KinectIds& ids, double shared);

  /// Returns the errors [25] in the axes of the heading, sd 1, for poses [25,3] m.
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
