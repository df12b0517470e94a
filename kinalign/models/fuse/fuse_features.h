// SPDX-License-Identifier: Apache-2.0
// Channels that a network sees of a Kinect and of inertial nodes, the same in training and at use.
// Both devices have one grid and one world; each may be absent. All channels are in one space that
// goes along with the body: the orientation of the root's node where that is valid, else the
// heading of the hips and shoulders that the Kinect sees.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/models/pose/pose_features.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// T frames of both devices. A device that is absent has no valid sample and no joint that is seen.
struct FuseInput {
  NodeFrames nodes;    // calibrated, [T,N]
  JointFrames kinect;  // [T,J]

  std::size_t frames() const { return nodes.frames(); }
};

struct FuseLayout {
  PoseLayout nodes;                 // inputs `ours`; its bones are those that are answered
  std::vector<std::string> joints;  // [J] the Kinect's (fuse_joints)

  /// Position (3) and state of each joint, and whether the root and the body are seen.
  std::size_t kinect_channels() const { return 4 * joints.size() + 1; }
  std::size_t node_channels() const { return nodes.channels() + 1; }
  std::size_t channels() const { return kinect_channels() + node_channels(); }
  /// Six numbers of each bone and of the root, in the space of the frame, and the way from the
  /// Kinect's SpineBase to the root.
  std::size_t answers() const { return 6 * (nodes.bones.size() + 1) + 3; }

  bool operator==(const FuseLayout&) const = default;
};

/// A joint of the Kinect, and the joint of pose_joints that lies there.
struct FuseJoint {
  std::string_view kinect, body;
};

/// Without the tips of hands and the thumbs, which a Kinect only guesses.
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

/// Fails where the nodes do not fit (pose_features.h) or a joint that the space is found from is
/// not there: SpineBase, hips, shoulders.
Result<void> validate(const FuseLayout& layout);

/// The space of a frame, and a place to measure from.
struct FuseSpace {
  Eigen::Quaternionf turn = Eigen::Quaternionf::Identity();  // of the space in the world
  Eigen::Vector3f place = Eigen::Vector3f::Zero();           // m, of the Kinect's SpineBase
};

/// Makes the channels frame after frame. What neither device shows holds.
class FuseFeatureMaker {
 public:
  explicit FuseFeatureMaker(const FuseLayout& layout);

  /// Fills `out` [channels] from frame `t`.
  void make(const FuseInput& input, std::size_t t, std::span<float> out);
  /// Of the last frame made.
  const FuseSpace& space() const { return space_; }

 private:
  void find_space(const FuseInput& input, std::size_t t);

  const FuseLayout* layout_;
  PoseFeatureMaker nodes_;
  std::size_t base_;
  std::array<std::array<std::size_t, 2>, 2> pairs_;  // left and right: hips, shoulders
  FuseSpace space_;
  std::optional<Eigen::Vector2f> left_;  // smoothed, in the floor: x, z
};

struct FuseFeatures {
  std::vector<float> input;      // [T,C]
  std::vector<FuseSpace> space;  // [T]
};

FuseFeatures fuse_features(const FuseLayout& layout, const FuseInput& input);

}  // namespace kinalign
