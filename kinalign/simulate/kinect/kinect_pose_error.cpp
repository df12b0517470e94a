// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_pose_error.h"

#include "kinalign/simulate/kinect/kinect_draws.h"
#include "kinalign/simulate/kinect/kinect_noise.h"

#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

// Distance between poses beyond which their errors are nearly independent. Fitted to the
// autocorrelation at 15 frames. It also gives the measured negative values at 20 and 30 frames.
constexpr double reach = 0.25;  // m

Vec3 normals(const RandomStream& random, std::uint64_t k, std::uint64_t lane) {
  return {random.normal(k, lane), random.normal(k, lane + 2), random.normal(k, lane + 4)};
}

}  // namespace

// Frequencies and phases belong to the take, so two cameras see the same function of the pose. Only
// a part of the waves' sizes differs between cameras.
KinectPoseError::KinectPoseError(const KinectIds& ids, double shared) {
  const RandomStream of_body = kinect_take_stream(KinectDraw::pose_noise, ids);
  const RandomStream of_camera = kinect_stream(KinectDraw::pose_noise, ids);
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    for (std::size_t w = 0; w < waves; ++w) {
      const std::uint64_t k = j * waves + w;
      Wave& wave = waves_[j][w];
      wave.along = normals(of_body, k, 0) / reach;
      wave.phase = 2.0 * std::numbers::pi * of_body.uniform(k, 6);
      wave.size = std::sqrt(2.0 / waves) * (std::sqrt(shared) * normals(of_body, k, 8) +
                                            std::sqrt(1.0 - shared) * normals(of_camera, k, 8));
    }
  }
}

std::array<Vec3, kinect_joint_count> KinectPoseError::at(std::span<const double> poses) const {
  std::array<Vec3, kinect_joint_count> errors;
  for (const KinectJoint j : kinect_tree_order) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    Vec3 own = Vec3::Zero();
    for (const Wave& wave : waves_[j]) {
      own += std::cos(wave.along.dot(vec3(poses, j)) + wave.phase) * wave.size;
    }
    const Vec3 kin = noise.source == j ? Vec3::Zero() : errors[noise.source];
    errors[j] = noise.kinship * kin + std::sqrt(1.0 - noise.kinship * noise.kinship) * own;
  }
  return errors;
}

}  // namespace kinalign
