// SPDX-License-Identifier: Apache-2.0
// The body as capsules (cylinders with round ends), and a test whether a capsule hides a joint from
// the camera.
#pragma once

#include "kinalign/motion/arrays.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <array>
#include <optional>
#include <span>

namespace kinalign {

struct KinectCapsule {
  KinectJoint from, to;
  double KinectRadii::*radius;
};

inline constexpr std::array<KinectCapsule, 10> kinect_capsules{{
    {neck, head, &KinectRadii::head},
    {spine_base, spine_shoulder, &KinectRadii::trunk},
    {shoulder_left, elbow_left, &KinectRadii::upper_arm},
    {shoulder_right, elbow_right, &KinectRadii::upper_arm},
    {elbow_left, hand_left, &KinectRadii::forearm},
    {elbow_right, hand_right, &KinectRadii::forearm},
    {hip_left, knee_left, &KinectRadii::thigh},
    {hip_right, knee_right, &KinectRadii::thigh},
    {knee_left, ankle_left, &KinectRadii::shank},
    {knee_right, ankle_right, &KinectRadii::shank},
}};

struct NearestOnSegments {
  double distance = 0.0;  // m
  Vec3 on_first = Vec3::Zero(), on_second = Vec3::Zero();
};

/// Returns the nearest points of the segments a0 a1 and b0 b1 (Ericson, «Real-Time Collision
/// Detection», 2005, section 5.1.9).
NearestOnSegments nearest_on_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0,
                                      const Vec3& b1);

/// Returns the point on the axis of a capsule that hides a joint; absent if the joint is visible.
/// `joints` [25,3] m, with the camera at the origin. A joint is not hidden by the part of the body
/// to which it belongs.
std::optional<Vec3> hidden_behind(std::span<const double> joints, KinectJoint joint,
                                  const KinectRadii& radii);

}  // namespace kinalign
