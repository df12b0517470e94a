// SPDX-License-Identifier: Apache-2.0
// Directions of bones, as a Kinect sees them and as a body has them at rest.
#pragma once

#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/models/pose/pose_body.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// A bone that a Kinect shows: from one of its joints to another.
struct SeenBone {
  std::size_t from = 0, to = 0;            // indices into the Kinect's joints
  Eigen::Vector3f axis{0.0F, 1.0F, 0.0F};  // unit, in the bone's own space
  std::size_t bone = 0;                    // whose rotation turns it: index into the body's bones;
                                           // their number: the root
};

/// The way from a joint to another, both of pose_joints, and the bone of PoseBody that turns it;
/// "" is the root. None where the Kinect lacks a joint or the body's joints lie on each other.
std::optional<SeenBone> seen_bone(const PoseBody& body, const std::vector<std::string>& kinect,
                                  std::string_view from, std::string_view to,
                                  std::string_view bone);

/// The bones of the body that a Kinect shows. Those above come first.
std::vector<SeenBone> seen_bones(const PoseBody& body, const std::vector<std::string>& kinect);

/// The direction of the bone in frame `t`, unit, in the world; none where a joint is missing.
struct SeenDirection {
  Eigen::Vector3f direction{0.0F, 1.0F, 0.0F};
  bool tracked = false;  // both joints; else one of them is inferred
};
std::optional<SeenDirection> direction_at(const JointFrames& kinect, std::size_t t,
                                          const SeenBone& bone);

/// Turns each bone of which both joints are tracked in frame `t` towards the Kinect's direction,
/// along the shortest way: half the way, less where it is far (a quarter at 45 degrees). A network
/// that has not learnt a movement answers with one that it knows; the joints that are seen tell
/// the rest. `root`: in the world. `rotations` [B] against it.
void turn_to_seen(std::span<const SeenBone> bones, const JointFrames& kinect, std::size_t t,
                  const Eigen::Quaternionf& root, std::span<Turn> rotations);

/// Gives joints back to their side where the Kinect takes a person's back for the front: where its
/// hips look against the way that the root's node looks.
void unexchange(const FuseLayout& layout, FuseInput& input);

}  // namespace kinalign
