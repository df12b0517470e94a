// SPDX-License-Identifier: Apache-2.0
// Finds the places of a Kinect's 25 joints in another skeleton. Such a place is at a joint, or at a
// share of the way from a joint to another joint or to its end site. Joints are mapped by height. A
// map by name would be wrong by 10 to 14 cm in the spine. Remaining differences (widths, the
// Kinect's place of a knee) are left to a calibration.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/kinect_joints.h"
#include "kinalign/motion/pose.h"

#include <array>
#include <span>

namespace kinalign {

/// position = joint + share * (towards - joint) + rotation of the joint * along.
struct KinectPlace {
  std::size_t joint = 0, towards = 0;
  double share = 0.0;
  Vec3 along = Vec3::Zero();  // m, in the joint's space; part of the offset of its end site
};

struct KinectMap {
  std::array<KinectPlace, kinect_joints.size()> places;  // in the order of kinect_joints
};

/// The map for skeletons with known names: Perception Neuron as written by Axis Neuron (legacy) or
/// by Axis Studio, and the CMU motion capture database as converted to BVH by cgspeed. Further
/// joints and another order are accepted. Fails if joints are missing; the message names the most
/// similar skeleton and its missing joints.
Result<KinectMap> kinect_map(const Skeleton& skeleton);

/// Fills `out` [25,3] m, in the order of kinect_joints, in the space of the pose's roots.
void kinect_positions(const KinectMap& map, const GlobalPose& pose, std::span<double> out);

}  // namespace kinalign
