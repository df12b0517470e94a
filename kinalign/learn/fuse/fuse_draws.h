// SPDX-License-Identifier: Apache-2.0
// Random variations of the training input: crops of both devices with fresh errors, sometimes with
// one device or one limb missing.
#pragma once

#include "kinalign/learn/pose/node_errors.h"
#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/simulate/random.h"

#include <string>
#include <vector>

namespace kinalign {

enum class Devices : std::uint8_t { both, kinect, nodes };

/// Modality dropout: each device is missing in some crops, so the trained network works with either
/// device alone and with both. In every crop at least one device is left.
struct FuseDraws {
  Devices devices = Devices::both;  // a device that is not listed is always missing
  NodeErrors errors{.yaw_deg = 8.0};
  /// Probabilities per crop. `unknown_heading`: large heading errors, as before a Kinect has seen
  /// the person. `lost_part`: a limb of the Kinect or one node is missing for some time.
  double unknown_heading = 0.15, without_kinect = 0.2, without_nodes = 0.2, lost_part = 0.5;
  /// Share of lost parts that are a limb of the Kinect; the others are nodes.
  double lost_limb = 0.7;
  double unknown_deg = 20.0;  // unknown headings are uniform within +- this, degrees
  double least_lost_s = 0.3, most_lost_s = 5.0;
};

/// The Kinect's joints of one limb.
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

/// Sets the joints of limb `limb` to missing in frames begin ... end - 1. `names` [J].
void lose_limb(JointFrames& kinect, const std::vector<std::string>& names, std::size_t limb,
               std::size_t begin, std::size_t end);
/// Marks all joints or nodes as missing. Their positions and orientations stay in the arrays.
void lose_kinect(JointFrames& kinect);
void lose_nodes(NodeFrames& nodes);

/// Applies the random variations. `input`: nodes without errors. The same seed and number give the
/// same result.
/// Called for each crop of a batch, and for each validation sequence with probability 0 for
/// missing devices and parts.
FuseInput drawn_input(FuseInput input, const FuseLayout& layout, const FuseDraws& draws,
                      std::uint64_t seed, std::uint64_t number);

}  // namespace kinalign
