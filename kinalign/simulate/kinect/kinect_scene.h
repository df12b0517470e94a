// SPDX-License-Identifier: Apache-2.0
// A body in front of a Kinect, frame by frame: the input of every step of the model.
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"

namespace kinalign {

/// The direction that a body faces. Columns of `axes`: the person's left, up, the front.
struct BodyHeading {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // camera_from_heading
  double yaw = 0.0;          // rad in [0, pi], between the front and the direction to the camera
  bool left_is_far = false;  // the left side is farther from the camera
};

/// At this rate of change of the pose (KinectScene::stir), or a greater one, the error of a moving
/// body has its full size.
inline constexpr double full_stir = 0.25;  // m/s

/// It holds the truth and what follows from it, and is never changed by the steps of the model.
struct KinectScene {
  std::span<const KinectTick> ticks;  // [T]
  std::vector<double> truth;          // [T,25,3] m, camera space
  std::vector<std::uint8_t> known;    // [T,25] 0: the truth is no number or impossibly far away
  std::vector<BodyHeading> headings;  // [T]
  std::vector<double> speeds;         // [T,25] m/s
  std::vector<double> bustle;         // [T] m/s, mean speed of all joints over 0.5 s
  std::vector<double> poses;  // [T,25,3] m, heading space; limbs relative to the spine's base, the
                              // torso relative to the middle of the ankles
  std::vector<double> stir;   // [T,25] m/s, rate of change of the pose, mean over 0.5 s

  std::size_t frames() const { return ticks.size(); }
  /// The true joints of a frame [25,3].
  std::span<const double> joints(std::size_t t) const {
    return {&truth[3 * kinect_joint_count * t], 3 * kinect_joint_count};
  }
};

KinectScene kinect_scene(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                         const KinectOptions& options);

/// True if the frames between these two were seen, so that their difference is a motion.
bool follows(const KinectTick& before, const KinectTick& after);

}  // namespace kinalign
