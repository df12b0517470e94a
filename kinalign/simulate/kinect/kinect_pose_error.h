// SPDX-License-Identifier: Apache-2.0
// Errors that depend on the pose: the same error whenever the body has the same pose.
#pragma once

#include "kinalign/simulate/kinect/kinect_scene.h"

#include <array>

namespace kinalign {

/// A smooth random function of each joint's pose, of unit variance for each axis over all poses.
/// Poses at distance d have the correlation exp(-d^2 / 2 l^2). The function is correlated along the
/// tree of joints. It is a sum of waves, «random Fourier features» (Rahimi and Recht, NIPS 2007).
class KinectPoseError {
 public:
  /// `shared`: share of the variance that is common to all cameras on a take.
  KinectPoseError(const KinectIds& ids, double shared);

  /// Errors [25] in heading space, sd 1, for poses [25,3] m.
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
