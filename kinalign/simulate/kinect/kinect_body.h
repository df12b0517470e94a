// SPDX-License-Identifier: Apache-2.0
// The body as reported by Kinect v2: 25 joints in the order of the SDK, their parents, and the
// radii of the parts of the body.
#pragma once

#include "kinalign/motion/kinect_joints.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

/// The numbers of JointType in the SDK. kinalign/motion/kinect_joints.h has the names.
enum KinectJoint : std::uint8_t {
  spine_base,
  spine_mid,
  neck,
  head,
  shoulder_left,
  elbow_left,
  wrist_left,
  hand_left,
  shoulder_right,
  elbow_right,
  wrist_right,
  hand_right,
  hip_left,
  knee_left,
  ankle_left,
  foot_left,
  hip_right,
  knee_right,
  ankle_right,
  foot_right,
  spine_shoulder,
  hand_tip_left,
  thumb_left,
  hand_tip_right,
  thumb_right
};
inline constexpr std::size_t kinect_joint_count = 25;

enum class KinectPart : std::uint8_t { trunk, arm, leg };
enum class KinectSide : std::uint8_t { middle, left, right };

struct KinectLimb {
  KinectJoint parent;  // the root's parent is the root itself
  KinectPart part;
  KinectSide side;
  /// The same joint on the other side. For a joint in the middle, it is the joint itself.
  KinectJoint partner;
};

/// The position of each joint in the body; [25] in the order of JointType.
inline constexpr std::array<KinectLimb, kinect_joint_count> kinect_limbs = [] {
  using enum KinectPart;
  using enum KinectSide;
  return std::array<KinectLimb, kinect_joint_count>{{
      {spine_base, trunk, middle, spine_base},     {spine_base, trunk, middle, spine_mid},
      {spine_shoulder, trunk, middle, neck},       {neck, trunk, middle, head},
      {spine_shoulder, arm, left, shoulder_right}, {shoulder_left, arm, left, elbow_right},
      {elbow_left, arm, left, wrist_right},        {wrist_left, arm, left, hand_right},
      {spine_shoulder, arm, right, shoulder_left}, {shoulder_right, arm, right, elbow_left},
      {elbow_right, arm, right, wrist_left},       {wrist_right, arm, right, hand_left},
      {spine_base, leg, left, hip_right},          {hip_left, leg, left, knee_right},
      {knee_left, leg, left, ankle_right},         {ankle_left, leg, left, foot_right},
      {spine_base, leg, right, hip_left},          {hip_right, leg, right, knee_left},
      {knee_right, leg, right, ankle_left},        {ankle_right, leg, right, foot_left},
      {spine_mid, trunk, middle, spine_shoulder},  {hand_left, arm, left, hand_tip_right},
      {hand_left, arm, left, thumb_right},         {hand_right, arm, right, hand_tip_left},
      {hand_right, arm, right, thumb_left},
  }};
}();

static_assert([] {
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    if (static_cast<std::size_t>(kinect_limbs[j].parent) != kinect_parents[j]) return false;
  }
  return true;
}());

/// Returns whether the tracker finds this joint by the surface of the torso: joints of the trunk,
/// shoulders and hips.
constexpr bool of_torso(KinectJoint joint) {
  return kinect_limbs[joint].part == KinectPart::trunk || joint == shoulder_left ||
         joint == shoulder_right || joint == hip_left || joint == hip_right;
}

/// All 25 joints. Each joint follows its parent.
inline constexpr std::array<KinectJoint, kinect_joint_count> kinect_tree_order{
    spine_base,     spine_mid,      spine_shoulder, neck,        head,
    shoulder_left,  elbow_left,     wrist_left,     hand_left,   hand_tip_left,
    thumb_left,     shoulder_right, elbow_right,    wrist_right, hand_right,
    hand_tip_right, thumb_right,    hip_left,       knee_left,   ankle_left,
    foot_left,      hip_right,      knee_right,     ankle_right, foot_right};

/// Radii of the parts of the body, m. Estimates.
struct KinectRadii {
  double head = 0.10, trunk = 0.12, upper_arm = 0.05, forearm = 0.04, thigh = 0.08, shank = 0.055;
};

}  // namespace kinalign
