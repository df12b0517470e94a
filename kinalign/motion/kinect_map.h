// SPDX-License-Identifier: Apache-2.0
// Where the 25 joints of a Kinect lie in another skeleton: a joint, and a share of the way from it
// to another one or to its end site. By height and not by name: by name the spine would be 10 to
// 14 cm off. What stays (widths, what the Kinect takes for a knee) is calibration's, not a map's.
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
  Vec3 along = Vec3::Zero();  // m, in the joint's space: its share of the way to an end site
};

struct KinectMap {
  std::array<KinectPlace, kinect_joints.size()> places;  // in the order of kinect_joints
};

/// For the skeletons whose names we know: Perception Neuron (legacy: Axis Neuron; Studio: Axis
/// Studio), and CMU's as cgspeed converted them; with more joints or in another order, too. Fails
/// where joints of the nearest of them are missing, and names these.
Result<KinectMap> kinect_map(const Skeleton& skeleton);

/// Fills `out` [25,3] m, in the order of kinect_joints, in the space of the pose's roots.
void kinect_positions(const KinectMap& map, const GlobalPose& pose, std::span<double> out);

}  // namespace kinalign
