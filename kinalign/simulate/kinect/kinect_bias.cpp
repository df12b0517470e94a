// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_bias.h"

#include "kinalign/simulate/kinect/kinect_draws.h"
#include "kinalign/simulate/kinect/kinect_noise.h"

#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

using Offsets = std::array<Vec3, kinect_joint_count>;

// Share of the variance between takes that differs from camera to camera. The rest comes from the
// way a person stands and is the same for both cameras. Two parallel Kinects differ by 0.7 to 1.8
// cm, takes by 1.8 to 5.2 cm.
constexpr double camera_share = 0.15;
// Share of the standard deviation between takes that does not come from the poses
// (kinect_pose_error.h). Fitted to PA-MPJPE, the mean joint error after a rigid fit.
constexpr double left_of_take = 0.45;

/// Returns standard normal draws for all joints, correlated along the tree of joints.
Offsets tree_of_draws(const RandomStream& random) {
  Offsets draws;
  for (const KinectJoint j : kinect_tree_order) {
    const Vec3 own(random.normal(j, 0), random.normal(j, 2), random.normal(j, 4));
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const Vec3 kin = noise.source == j ? Vec3::Zero() : draws[noise.source];
    draws[j] = noise.kinship * kin + std::sqrt(1.0 - noise.kinship * noise.kinship) * own;
  }
  return draws;
}

/// Returns the offsets of this person in this take, in the axes of the body's heading, m.
Offsets standing_offsets(const KinectIds& ids) {
  const Offsets person = tree_of_draws(kinect_person_stream(KinectDraw::person_bias, ids));
  const Offsets take = tree_of_draws(kinect_take_stream(KinectDraw::take_bias, ids));
  const Offsets camera = tree_of_draws(kinect_stream(KinectDraw::camera_bias, ids));
  Offsets offsets;
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const Vec3 of_take =
        std::sqrt(1.0 - camera_share) * take[j] + std::sqrt(camera_share) * camera[j];
    offsets[j] = noise.offset + (noise.person * person[j] + left_of_take * noise.take * of_take) /
                                    std::numbers::sqrt3;
  }
  // The neck is the mean of its neighbours, as in kinect_coloured.cpp.
  offsets[neck] = 0.5 * (offsets[spine_shoulder] + offsets[head]);
  return offsets;
}

// Estimated from two Kinects at 45 and 90 degrees, m.
constexpr double trunk_turned = 0.06, near_turned = 0.04, far_leg_turned = 0.05,
                 far_arm_turned = 0.05;

/// Returns the size of the error, m, of a joint of a body that is seen from the side.
double turned_bias(const KinectLimb& place, bool left_is_far) {
  if (place.part == KinectPart::trunk) return trunk_turned;
  const bool far = (place.side == KinectSide::left) == left_is_far;
  if (!far) return near_turned;
  return place.part == KinectPart::arm ? far_arm_turned : far_leg_turned;
}

/// Returns the directions in which the joints of a turned body are displaced: half along the
/// optical axis, half random.
Offsets turned_directions(const RandomStream& random) {
  Offsets directions = tree_of_draws(random);
  for (Vec3& direction : directions) {
    const double sign = direction.z() < 0.0 ? -1.0 : 1.0;
    direction =
        (0.5 * sign * Vec3::UnitZ() + std::sqrt(0.75) * direction.normalized()).normalized();
  }
  return directions;
}

// Factor for a body seen from the back, where the tracker recognises less than from the side.
// Fitted to two Kinects in front of a body that turns.
constexpr double of_back = 1.9;

/// Returns the share of the error for a turned body. It is small up to 45 degrees, where limbs have
/// errors of 1.3 to 3.0 cm, and 1 at 90 degrees.
double turned_share(double yaw) {
  const double sideways = std::pow(std::sin(yaw), 2);
  return yaw <= std::numbers::pi / 2.0 ? sideways : of_back + (1.0 - of_back) * sideways;
}

}  // namespace

void add_kinect_bias(const KinectScene& scene, const KinectIds& ids, std::span<double> joints) {
  const Offsets offsets = standing_offsets(ids);
  const Offsets directions = turned_directions(kinect_stream(KinectDraw::yaw_bias, ids));
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const BodyHeading& heading = scene.headings[t];
    const double turned = turned_share(heading.yaw);
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const double size = turned * turned_bias(kinect_limbs[j], heading.left_is_far);
      vec3(joints, t * kinect_joint_count + j) += heading.axes * offsets[j] + size * directions[j];
    }
  }
}

}  // namespace kinalign
