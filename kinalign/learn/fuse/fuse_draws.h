// SPDX-License-Identifier: Apache-2.0
// What a network sees while it learns: crops of both devices with fresh errors, and at times only
// one of the devices, or one without a limb.
#pragma once

#include "kinalign/learn/pose/node_errors.h"
#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/simulate/random.h"

#include <string>
#include <vector>

namespace kinalign {

enum class Devices : std::uint8_t { both, kinect, nodes };

struct FuseDraws {
  Devices devices = Devices::both;  // the others are never there
  NodeErrors errors{.yaw_deg = 8.0};
  /// Shares of crops: headings still unknown, as they are before a Kinect has seen anything; the
  /// whole Kinect missing; all nodes missing; a limb of the Kinect or a node missing for a while.
  double unknown_heading = 0.15, without_kinect = 0.2, without_nodes = 0.2, lost_part = 0.5;
  double lost_limb = 0.7;     // of the lost parts: a limb of the Kinect; else a node
  double unknown_deg = 20.0;  // headings lie within +- this
  double least_lost_s = 0.3, most_lost_s = 5.0;
};

/// A Kinect's joints of one limb.
struct KinectLimbJoints {
  std::string_view name;
  std::array<std::string_view, 3> joints;
};
inline constexpr std::array<KinectLimbJoints, 4> kinect_limb_joints{{
    {"left arm", {"ElbowLeft", "WristLeft", "HandLeft"}},
    {"right arm", {"ElbowRight", "WristRight", "HandRight"}},
    {"left leg", {"KneeLeft", "AnkleLeft", "FootLeft"}},
    {"right leg", {"KneeRight", "AnkleRight", "FootRight"}},
}};

/// Joints of limb `limb` missing in frames begin ... end - 1. `names` [J].
void lose_limb(JointFrames& kinect, const std::vector<std::string>& names, std::size_t limb,
               std::size_t begin, std::size_t end);
void lose_kinect(JointFrames& kinect);
void lose_nodes(NodeFrames& nodes);

/// `input`: without errors of nodes. The same seed and number give the same draw.
FuseInput drawn_input(FuseInput input, const FuseLayout& layout, const FuseDraws& draws,
                      std::uint64_t seed, std::uint64_t number);

}  // namespace kinalign
