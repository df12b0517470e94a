// SPDX-License-Identifier: Apache-2.0
// A body and motions for tests of poses.
#pragma once

#include "kinalign/models/pose/pose_body.h"
#include "kinalign/models/pose/pose_features.h"

#include <random>
#include <vector>

namespace kinalign {

/// Offsets of a T-pose, about 1.6 m tall, in the order of pose_joints.
inline std::vector<Vec3> test_offsets() {
  return {{0, 0, 0},        {0.1, -0.05, 0}, {0, -0.4, 0},  {0, -0.42, 0},   {0, -0.05, 0.1},
          {-0.1, -0.05, 0}, {0, -0.4, 0},    {0, -0.42, 0}, {0, -0.05, 0.1}, {0, 0.1, 0},
          {0, 0.12, 0},     {0, 0.12, 0},    {0, 0.12, 0},  {0, 0.06, 0},    {0, 0.08, 0},
          {0.02, 0.1, 0},   {0.16, 0, 0},    {0.28, 0, 0},  {0.13, 0, 0},    {0.13, 0, 0},
          {0.08, 0, 0},     {-0.02, 0.1, 0}, {-0.16, 0, 0}, {-0.28, 0, 0},   {-0.13, 0, 0},
          {-0.13, 0, 0},    {-0.08, 0, 0}};
}

inline Eigen::Quaternionf random_turn(std::mt19937_64& random) {
  std::normal_distribution<float> normal;
  Eigen::Quaternionf out(normal(random), normal(random), normal(random), normal(random));
  return out.normalized();
}

inline std::vector<Turn> random_turns(std::size_t n, std::mt19937_64& random) {
  std::vector<Turn> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(random_turn(random).toRotationMatrix());
  return out;
}

inline void append_sample(NodeFrames& nodes, const Eigen::Quaternionf& q, const Eigen::Vector3f& a,
                          const Eigen::Vector3f& w) {
  for (const float value : {q.w(), q.x(), q.y(), q.z()}) nodes.orientation.push_back(value);
  for (const float value : a) nodes.acceleration.push_back(value);
  for (const float value : w) nodes.angular_velocity.push_back(value);
  nodes.valid.push_back(1);
}

inline NodeFrames random_nodes(std::size_t count, std::size_t frames, std::mt19937_64& random) {
  NodeFrames out;
  out.nodes = count;
  std::normal_distribution<float> normal;
  const auto vector = [&](float scale) {
    Eigen::Vector3f v;
    for (float& value : v) value = scale * normal(random);
    return v;
  };
  for (std::size_t i = 0; i < count * frames; ++i) {
    const Eigen::Vector3f a = vector(5.0F), w = vector(2.0F);
    append_sample(out, random_turn(random), a, w);
  }
  return out;
}

inline PoseLayout test_layout() {
  PoseLayout out;
  out.nodes = {"wrist_left", "wrist_right", "ankle_left", "ankle_right", "waist"};
  out.bones.assign(pose_bones.begin(), pose_bones.end());
  return out;
}

}  // namespace kinalign
