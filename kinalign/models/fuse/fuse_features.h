// SPDX-License-Identifier: Apache-2.0
// Input channels of a network that fuses a Kinect and inertial nodes, the same in training and in
// use. Both devices share one grid and one world; each may be absent. All channels are in one space
// that moves with the body. Its rotation is that of the root's node if the node is valid, else the
// heading of the hips and shoulders in the Kinect's data.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/models/pose/pose_features.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// T frames of both devices. An absent device has no valid sample and no seen joint.
struct FuseInput {
  NodeFrames nodes;    // calibrated, [T,N]
  JointFrames kinect;  // [T,J] the joints, in the same world as the nodes

  std::size_t frames() const { return nodes.frames(); }
};

struct FuseLayout {
  PoseLayout nodes;                 // inputs must be `ours`; its bones are the network's outputs
  std::vector<std::string> joints;  // [J] names of the Kinect's joints (fuse_joints)

  /// Position (3) and state (1) of each joint, and one flag: is the Kinect's SpineBase seen?
  std::size_t kinect_channels() const { return 4 * joints.size() + 1; }
  /// The nodes' channels and one flag: is the root's node valid?
  std::size_t node_channels() const { return nodes.channels() + 1; }
  std::size_t channels() const { return kinect_channels() + node_channels(); }
  /// Six numbers for each bone and for the root, in the space of the frame, and the vector from the
  /// Kinect's SpineBase to the root.
  std::size_t answers() const { return 6 * (nodes.bones.size() + 1) + 3; }

  bool operator==(const FuseLayout&) const = default;
};

/// A joint of the Kinect and the joint of pose_joints at the same place.
struct FuseJoint {
  std::string_view kinect, body;
};

/// Hand tips and thumbs are left out because a Kinect only guesses them.
inline constexpr std::array<FuseJoint, 21> fuse_joints{{
    {"SpineBase", "root"},     {"SpineMid", "upperback"},    {"Neck", "lowerneck"},
    {"Head", "head"},          {"ShoulderLeft", "lhumerus"}, {"ElbowLeft", "lradius"},
    {"WristLeft", "lhand"},    {"HandLeft", "lfingers"},     {"ShoulderRight", "rhumerus"},
    {"ElbowRight", "rradius"}, {"WristRight", "rhand"},      {"HandRight", "rfingers"},
    {"HipLeft", "lfemur"},     {"KneeLeft", "ltibia"},       {"AnkleLeft", "lfoot"},
    {"FootLeft", "ltoes"},     {"HipRight", "rfemur"},       {"KneeRight", "rtibia"},
    {"AnkleRight", "rfoot"},   {"FootRight", "rtoes"},       {"SpineShoulder", "thorax"},
}};
std::vector<std::string> fuse_joint_names();

/// Fails if the nodes are not valid (pose_features.h) or if a joint is absent that the body's space
/// needs: SpineBase, hips, shoulders.
Result<void> validate(const FuseLayout& layout);

/// The space of one frame, and its origin. The network's output for a frame is in this space. Each
/// space is therefore stored until the output is transformed back into the world.
struct FuseSpace {
  Eigen::Quaternionf turn = Eigen::Quaternionf::Identity();  // the space's rotation in the world
  Eigen::Vector3f place = Eigen::Vector3f::Zero();  // m, the Kinect's SpineBase in the world
};

/// Makes the channels frame after frame. If neither device shows the heading or the position, the
/// last known heading or position is kept.
class FuseFeatureMaker {
 public:
  explicit FuseFeatureMaker(const FuseLayout& layout);

  /// Fills `out` [channels] from frame `t`.
  void make(const FuseInput& input, std::size_t t, std::span<float> out);
  /// The space of the last frame made.
  const FuseSpace& space() const { return space_; }

 private:
  void find_space(const FuseInput& input, std::size_t t);

  const FuseLayout* layout_;
  PoseFeatureMaker nodes_;
  std::size_t base_;
  std::array<std::array<std::size_t, 2>, 2> pairs_;  // {left, right} joints: hips, shoulders
  FuseSpace space_;
  std::optional<Eigen::Vector2f> left_;  // smoothed left direction in the floor plane: x, z
};

struct FuseFeatures {
  std::vector<float> input;      // [T,C] the channels of each frame
  std::vector<FuseSpace> space;  // [T] the space of each frame
};

/// The features of all frames.
FuseFeatures fuse_features(const FuseLayout& layout, const FuseInput& input);

}  // namespace kinalign
