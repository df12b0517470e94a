// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_capsules.h"

#include <algorithm>

namespace kinalign {

namespace {

// A surface that is less than this distance before a joint belongs to the joint itself, m. An
// estimate.
constexpr double own_flesh = 0.05;
// Shoulders are inside the trunk's capsule or at its side. Therefore only the core of the trunk
// hides a shoulder, and only if it is well before the shoulder. Estimates: with the whole capsule,
// a narrow person's shoulders were hidden from the front.
constexpr double shoulder_flesh = 0.14, core = 0.4;

bool is_shoulder(KinectJoint joint) { return joint == shoulder_left || joint == shoulder_right; }

/// Returns whether the joint belongs to the capsule's part of the body. Hands belong to forearms,
/// feet to shanks, hips and spine to the trunk. Shoulders do not belong to the trunk, because the
/// trunk hides the far shoulder of a turned body.
bool belongs(KinectJoint joint, const KinectCapsule& capsule) {
  if (joint == capsule.from || joint == capsule.to) return true;
  const KinectLimb& place = kinect_limbs[joint];
  const bool hip = joint == hip_left || joint == hip_right;
  // The tracker finds these joints by the whole surface of the torso. An arm before the torso hides
  // only a small part of it.
  if (of_torso(joint) && kinect_limbs[capsule.to].part == KinectPart::arm) return true;
  if (capsule.to == head) return place.part == KinectPart::trunk || is_shoulder(joint);
  if (capsule.from == spine_base) return place.part == KinectPart::trunk ? joint != head : hip;
  if (capsule.to == knee_left || capsule.to == knee_right) return hip || joint == spine_base;
  if (place.side != kinect_limbs[capsule.to].side) return false;
  if (capsule.to == hand_left || capsule.to == hand_right) {
    return place.parent == capsule.to || place.parent == capsule.from;
  }
  return place.parent == ankle_left || place.parent == ankle_right ? capsule.to == place.parent
                                                                   : false;
}

/// Returns the parameter of a point on a segment, clamped to [0, 1]; 0 on a segment without length.
double along(double way, double length_squared) {
  return length_squared > 1e-12 ? std::clamp(way / length_squared, 0.0, 1.0) : 0.0;
}

}  // namespace

// Finds the nearest points of the two lines, then clamps each parameter to its segment. If the
// segments are parallel, the search begins at a0.
NearestOnSegments nearest_on_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0,
                                      const Vec3& b1) {
  const Vec3 a = a1 - a0, b = b1 - b0, r = a0 - b0;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
  const double ar = a.dot(r), br = b.dot(r);
  const double apart = aa * bb - ab * ab;
  double s = apart > 1e-12 ? std::clamp((ab * br - ar * bb) / apart, 0.0, 1.0) : 0.0;
  const double t = along(ab * s + br, bb);
  s = along(ab * t - ar, aa);
  NearestOnSegments found{0.0, a0 + s * a, b0 + t * b};
  found.distance = (found.on_first - found.on_second).norm();
  return found;
}

std::optional<Vec3> hidden_behind(std::span<const double> joints, KinectJoint joint,
                                  const KinectRadii& radii) {
  const Vec3 place = vec3(joints, joint);
  const double distance = place.norm();
  const double flesh = is_shoulder(joint) ? shoulder_flesh : own_flesh;
  if (distance <= flesh) return std::nullopt;
  // The ray ends shortly before the joint, so that the part of the body around the joint does not
  // hide it.
  const Vec3 before = place * (1.0 - flesh / distance);
  for (const KinectCapsule& capsule : kinect_capsules) {
    if (belongs(joint, capsule)) continue;
    const NearestOnSegments nearest = nearest_on_segments(
        Vec3::Zero(), before, vec3(joints, capsule.from), vec3(joints, capsule.to));
    const bool only_core = is_shoulder(joint) && capsule.from == spine_base;
    if (nearest.distance < (only_core ? core : 1.0) * radii.*capsule.radius)
      return nearest.on_second;
  }
  return std::nullopt;
}

}  // namespace kinalign
