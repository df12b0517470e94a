// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_coloured.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Share of the deviation from a bone's mean length that the tracker reports. Chosen so that bone
// lengths vary as much as measured on UI-PRMD.
constexpr double let_through = 0.53;

struct Bone {
  KinectJoint from, to;
};

// The bones in order from the trunk outwards.
constexpr std::array<Bone, 17> limb_bones = [] {
  return std::array<Bone, 17>{{{shoulder_left, elbow_left},
                               {elbow_left, wrist_left},
                               {wrist_left, hand_left},
                               {hand_left, hand_tip_left},
                               {hand_left, thumb_left},
                               {shoulder_right, elbow_right},
                               {elbow_right, wrist_right},
                               {wrist_right, hand_right},
                               {hand_right, hand_tip_right},
                               {hand_right, thumb_right},
                               {hip_left, knee_left},
                               {knee_left, ankle_left},
                               {ankle_left, foot_left},
                               {hip_right, knee_right},
                               {knee_right, ankle_right},
                               {ankle_right, foot_right},
                               {hip_left, hip_right}}};
}();
constexpr std::size_t hips = 16;  // index of the hips' width in the list

using Lengths = std::array<double, limb_bones.size()>;

Lengths lengths(std::span<const double> joints, std::size_t t) {
  Lengths found{};
  for (std::size_t b = 0; b < limb_bones.size(); ++b) {
    const auto [from, to] = limb_bones[b];
    found[b] =
        (vec3(joints, t * kinect_joint_count + to) - vec3(joints, t * kinect_joint_count + from))
            .norm();
  }
  return found;
}

/// Returns how much longer each bone is than the true bone, m, averaged over the take.
Lengths mean_excess(const KinectScene& scene, std::span<const double> joints) {
  Lengths means{};
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const Lengths now = lengths(joints, t), truth = lengths(scene.truth, t);
    for (std::size_t b = 0; b < means.size(); ++b) {
      means[b] += (now[b] - truth[b]) / static_cast<double>(scene.frames());
    }
  }
  return means;
}

/// Returns the true lengths plus the mean excess plus the reduced deviation.
Lengths held_lengths(const Lengths& now, const Lengths& truth, const Lengths& excess) {
  Lengths held{};
  for (std::size_t b = 0; b < held.size(); ++b) {
    const double mean = truth[b] + excess[b];
    held[b] = std::max(0.0, mean + let_through * (now[b] - mean));
  }
  return held;
}

/// Sets the lengths of the bones in one frame [25,3] to `held`, from the trunk outwards. The
/// distance between the hips is set first, because the legs begin at the hips.
void hold_frame(const Lengths& held, std::span<double> joints) {
  std::array<Vec3, kinect_joint_count> before;
  for (std::size_t j = 0; j < kinect_joint_count; ++j) before[j] = vec3(joints, j);
  const Vec3 across = before[hip_left] - before[hip_right];
  if (const double width = across.norm(); width > 1e-6) {
    const Vec3 half = across * (held[hips] / width / 2.0);
    const Vec3 middle = 0.5 * (before[hip_left] + before[hip_right]);
    vec3(joints, hip_left) = middle + half;
    vec3(joints, hip_right) = middle - half;
  }
  for (std::size_t b = 0; b < hips; ++b) {
    const auto [from, to] = limb_bones[b];
    const Vec3 bone = before[to] - before[from];
    const double length = bone.norm();
    const double scale = length > 1e-6 ? held[b] / length : 1.0;
    vec3(joints, to) = vec3(joints, from) + scale * bone;
  }
}

}  // namespace

void hold_bones(const KinectScene& scene, std::span<double> joints) {
  const Lengths excess = mean_excess(scene, joints);
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const Lengths held = held_lengths(lengths(joints, t), lengths(scene.truth, t), excess);
    hold_frame(held, joints.subspan(3 * kinect_joint_count * t, 3 * kinect_joint_count));
  }
}

}  // namespace kinalign
