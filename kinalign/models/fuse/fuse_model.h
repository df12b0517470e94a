// SPDX-License-Identifier: Apache-2.0
// A model that estimates a person's pose from a Kinect and inertial nodes together: its network and
// all settings needed to use it. The file's layout: docs/formats/model.md.
#pragma once

#include "kinalign/infer/network.h"
#include "kinalign/models/fuse/bone_filter.h"
#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/models/fuse/node_headings.h"
#include "kinalign/models/fuse/seen_bones.h"
#include "kinalign/models/pose/body_model.h"

#include <string>
#include <vector>

namespace kinalign {

/// Metres per unit of the network's output for the root's position relative to the Kinect's
/// SpineBase.
inline constexpr float fuse_place_unit_m = 0.1F;

/// BodyModel holds the network and the body; the layout adds the channels of both devices.
struct FuseModel : BodyModel {  // task "fuse"
  FuseLayout layout;
};

/// The bytes of a model's file. The same model gives the same bytes.
std::string write_fuse_model(const FuseModel& model);

/// Fails if the file is not a model of this task or its parts do not fit together.
Result<FuseModel> read_fuse_model(std::string_view bytes, const std::string& name);

/// One frame of a network's output, brought into the world.
struct FusedFrame {
  Eigen::Quaternionf root = Eigen::Quaternionf::Identity();
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
};
/// Converts one frame of a network's output [answers]. Fills `rotations` [B], each relative to the
/// root.
FusedFrame fused_frame(const FuseSpace& space, std::span<const float> answers,
                       std::span<Turn> rotations);

/// A network's output for rows `first` ... `end` - 1 of a sequence.
struct FuseAnswers {
  std::span<const FuseSpace> spaces;  // [T] the space of each frame
  std::span<const float> answers;     // [T,answers] the network's output
  std::size_t first = 0, end = 0;
};

/// A model ready for whole sequences. It can be used by one thread at a time.
class Fuser {
 public:
  static Result<Fuser> make(FuseModel model);

  const FuseModel& model() const { return model_; }

  /// Estimates the pose of a sequence. `input`: the layout's channels at its rate. The network
  /// first runs on the Kinect alone; that pose gives the nodes' headings (node_headings.h). Then
  /// the network runs on both devices with corrected headings. The result is turned towards the
  /// measurements of nodes and Kinect (turn_to_nodes(), turn_to_seen()), placed where the
  /// Kinect's joints lie, and smoothed if the model says so.
  FusedPose solve(const FuseInput& input) { return solve(input, headings(input)); }
  /// Estimates the pose of a sequence with known headings.
  FusedPose solve(const FuseInput& input, const std::vector<HeadingState>& headings);
  /// Only the headings [T,N].
  std::vector<HeadingState> headings(const FuseInput& input);
  /// Only the network's answer. `input`: with corrected headings.
  FusedPose answer(const FuseInput& input);

  const Network& network() const { return network_; }
  /// The pose of the rows `output.first` ... `output.end` - 1 of a network's output.
  FusedPose pose_of(const FuseAnswers& output) const;
  /// The same pose, turned towards the measurements of `input` [T], placed at the Kinect's joints
  /// and, if the model says so, smoothed. Near both ends the smoothing uses fewer rows.
  FusedPose measured_pose_of(const FuseAnswers& output, const FuseInput& input) const;

  /// The result of solve() as a clip: a skeleton with constant bones at its place in the Kinect's
  /// world. If no Kinect has seen anything, x and z of the root are 0 and the lowest joint is at y
  /// = 0.
  Clip clip(const FuseInput& input, Time start) { return clip(input, headings(input), start); }
  Clip clip(const FuseInput& input, const std::vector<HeadingState>& headings, Time start);

  /// Replaces the model's mean skeleton by that of the person; see PoseSolver::use_body().
  void use_body(Skeleton body) { model_.body.skeleton = std::move(body); }

 private:
  Fuser(FuseModel model, Network network);

  std::vector<float> run(FuseFeatures& features);
  void turn_to_measured(const FuseInput& input, std::size_t first, FusedPose& pose) const;
  void place_at_seen(const FuseInput& input, std::size_t first, FusedPose& pose) const;

  /// A joint of the Kinect, and the body's joint that lies there.
  struct SameJoint {
    std::size_t kinect = 0, body = 0;
  };

  FuseModel model_;
  Network network_;
  std::vector<SameJoint> same_joints_;
  Workspace workspace_;
};

}  // namespace kinalign
