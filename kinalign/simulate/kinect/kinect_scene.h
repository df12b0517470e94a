// SPDX-License-Identifier: Apache-2.0
// A body before a Kinect, frame by frame: what every step of the model starts from.
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"

namespace kinalign {

/// Which way a body faces. Columns of `axes`: the person's left, up, the front.
struct BodyHeading {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // camera_from_heading
  double yaw = 0.0;          // rad in [0, pi], between the front and the way to the camera
  bool left_is_far = false;  // the left side is the one away from the camera
};

/// A pose that changes as fast (KinectScene::stir) or faster has all of the error that moving
/// makes.
inline constexpr double full_stir = 0.25;  // m/s

struct KinectScene {
  std::span<const KinectTick> ticks;  // [T]
  std::vector<double> truth;          // [T,25,3] m, camera space
  std::vector<std::uint8_t> known;    // [T,25] 0: the truth is no number or not on this earth
  std::vector<BodyHeading> headings;  // [T]
  std::vector<double> speeds;         // [T,25] m/s
  std::vector<double> bustle;         // [T] m/s, mean of all joints' speeds over 0.5 s
  std::vector<double> poses;          // [T,25,3] m, heading space: limbs from the spine's base, the
                                      // torso from between the ankles
  std::vector<double> stir;           // [T,25] m/s, how fast poses change, mean over 0.5 s

  std::size_t frames() const { return ticks.size(); }
  /// The true ones of a frame [25,3].
  std::span<const double> joints(std::size_t t) const {
    return {&truth[3 * kinect_joint_count * t], 3 * kinect_joint_count};
  }
};

KinectScene kinect_scene(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                         const KinectOptions& options);

/// Frames between these two were seen, so that a difference over them is a motion.
bool follows(const KinectTick& before, const KinectTick& after);

}  // namespace kinalign
