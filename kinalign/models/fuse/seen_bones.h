// SPDX-License-Identifier: Apache-2.0
// Directions of bones as a Kinect sees them, and as the body has them at rest.
#pragma once

#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/models/pose/pose_body.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// A bone that a Kinect shows, between two of its joints. If the bone's rotation in the world is R,
/// the expected direction from the first joint to the second is R `axis`.
struct SeenBone {
  std::size_t from = 0, to = 0;            // indices into the Kinect's joints
  Eigen::Vector3f axis{0.0F, 1.0F, 0.0F};  // unit, in the bone's own space
  /// Index of the body's bone whose rotation turns the axis; the number of bones: the root.
  std::size_t bone = 0;
};

/// The index of the Kinect's joint that lies at a joint of pose_joints; empty if there is none.
std::optional<std::size_t> kinect_joint_at(const std::vector<std::string>& kinect,
                                           std::string_view body_joint);

/// The bone between two joints of pose_joints. `bone`: the bone of PoseBody that turns it; "" is
/// the root. Empty if the Kinect lacks a joint or both joints are at one place in the body.
std::optional<SeenBone> seen_bone(const PoseBody& body, const std::vector<std::string>& kinect,
                                  std::string_view from, std::string_view to,
                                  std::string_view bone);

/// The bones of the body that a Kinect shows, parents before children.
std::vector<SeenBone> seen_bones(const PoseBody& body, const std::vector<std::string>& kinect);

/// The direction of a bone in one frame, a unit vector in the world.
struct SeenDirection {
  Eigen::Vector3f direction{0.0F, 1.0F, 0.0F};
  bool tracked = false;  // true: both joints are tracked; false: at least one is inferred
};
/// The direction in frame `t`; empty if a joint is missing.
std::optional<SeenDirection> direction_at(const JointFrames& kinect, std::size_t t,
                                          const SeenBone& bone);

/// Turns each bone whose two joints are tracked in frame `t` towards the Kinect's direction, along
/// the shortest way. The share of the angle is one half, and less for large angles (a quarter at 45
/// degrees). For an unknown movement a network outputs a similar one that it has learnt; the seen
/// joints correct the difference. `root`: in the world. `rotations` [B]: relative to the root.
void turn_to_seen(std::span<const SeenBone> bones, const JointFrames& kinect, std::size_t t,
                  const Eigen::Quaternionf& root, std::span<Turn> rotations);

/// Exchanges left and right joints in frames in which the Kinect mistakes a person's back for the
/// front. In such frames the Kinect's direction across the hips and that of the root's node differ
/// by more than 120 degrees.
void unexchange(const FuseLayout& layout, FuseInput& input);

}  // namespace kinalign
