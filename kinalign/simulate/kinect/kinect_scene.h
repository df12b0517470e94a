// SPDX-License-Identifier: Apache-2.0
// A body in front of a Kinect, frame by frame: the input to every step of the model.
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"

namespace kinalign {

/// The direction that a body faces. The columns of `axes` are the person's left, up, and front.
struct BodyHeading {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // camera_from_heading
  double yaw = 0.0;          // rad in [0, pi], between the front and the direction to the camera
  bool left_is_far = false;  // the left side is farther from the camera than the right side
};

/// Rate of change of the pose (KinectScene::stir) from which on the error of a moving body has its
/// full size.
inline constexpr double full_stir = 0.25;  // m/s

/// The true joints and quantities that are computed from them. The steps of the model do not change
/// it.
struct KinectScene {
  std::span<const KinectTick> ticks;  // [T]
  std::vector<double> truth;          // [T,25,3] m, camera space
  std::vector<std::uint8_t> known;  // [T,25] 0: the true position is not finite or far too distant
  std::vector<BodyHeading> headings;  // [T]
  std::vector<double> speeds;         // [T,25] m/s
  std::vector<double> bustle;         // [T] m/s, mean speed of all joints over 0.5 s
  std::vector<double> poses;  // [T,25,3] m, axes of the heading; limbs relative to the base of the
                              // spine, torso relative to the middle of the ankles
  std::vector<double> stir;   // [T,25] m/s, rate of change of the pose, averaged over 0.5 s

  std::size_t frames() const { return ticks.size(); }
  /// Returns the true joints of a frame [25,3].
  std::span<const double> joints(std::size_t t) const {
    return {&truth[3 * kinect_joint_count * t], 3 * kinect_joint_count};
  }
};

KinectScene kinect_scene(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                         const KinectOptions& options);

/// Returns whether the two frames are close enough in time that their difference is a motion.
bool follows(const KinectTick& before, const KinectTick& after);

}  // namespace kinalign
