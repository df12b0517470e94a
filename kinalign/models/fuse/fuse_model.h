// SPDX-License-Identifier: Apache-2.0
// A model that answers with a person's pose to a Kinect and inertial nodes together: its network,
// and everything needed to use it. Layout of its file: docs/formats/model.md.
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

/// Metres of a network's 1, of the root's place against the Kinect's.
inline constexpr float fuse_place_unit_m = 0.1F;

struct FuseModel : BodyModel {  // task "fuse"
  FuseLayout layout;
};

/// The bytes of a model's file. The same model gives the same bytes.
std::string write_fuse_model(const FuseModel& model);

/// Fails where the file is no model of this task or its parts do not fit together.
Result<FuseModel> read_fuse_model(std::string_view bytes, const std::string& name);

/// One frame of a network's answers [answers], brought into the world.
struct FusedFrame {
  Eigen::Quaternionf root = Eigen::Quaternionf::Identity();
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
};
/// Fills `rotations` [B] against the root.
FusedFrame fused_frame(const FuseSpace& space, std::span<const float> answers,
                       std::span<Turn> rotations);

/// What a network says of rows `first` ... `end` - 1 of a sequence.
struct FuseAnswers {
  std::span<const FuseSpace> spaces;  // [T]
  std::span<const float> answers;     // [T,answers]
  std::size_t first = 0, end = 0;
};

/// A model ready for whole sequences. It can be used by one thread at a time.
class Fuser {
 public:
  static Result<Fuser> make(FuseModel model);

  const FuseModel& model() const { return model_; }

  /// `input`: the layout's, at its rate. The network answers to the Kinect alone first; that pose
  /// shows the nodes' headings (node_headings.h), and with these it answers to both. The answer is
  /// turned towards what the nodes and the Kinect measure (turn_to_nodes(), turn_to_seen()), placed
  /// where the Kinect's joints lie, and smoothed.
  FusedPose solve(const FuseInput& input) { return solve(input, headings(input)); }
  /// With headings that were found before.
  FusedPose solve(const FuseInput& input, const std::vector<HeadingState>& headings);
  /// The headings alone [T,N].
  std::vector<HeadingState> headings(const FuseInput& input);
  /// The network's answer alone. `input`: with corrected headings.
  FusedPose answer(const FuseInput& input);

  const Network& network() const { return network_; }
  /// The same of these rows, once the network has run.
  FusedPose pose_of(const FuseAnswers& said) const;
  /// Turned to what `input` [T] measures, and smoothed. At both ends fewer rows are smoothed over.
  FusedPose measured_pose_of(const FuseAnswers& said, const FuseInput& input) const;

  /// Of solve(): a skeleton with constant bones, at its place in the Kinect's world. Where no
  /// Kinect has seen anything, x and z of the root are 0 and the lowest joint is at y = 0.
  Clip clip(const FuseInput& input, Time start) { return clip(input, headings(input), start); }
  Clip clip(const FuseInput& input, const std::vector<HeadingState>& headings, Time start);

  /// As PoseSolver::use_body().
  void use_body(Skeleton body) { model_.body.skeleton = std::move(body); }

 private:
  Fuser(FuseModel model, Network network);

  std::vector<float> run(FuseFeatures& features);
  void turn_to_measured(const FuseInput& input, std::size_t first, FusedPose& pose) const;
  void place_at_seen(const FuseInput& input, std::size_t first, FusedPose& pose) const;

  FuseModel model_;
  Network network_;
  Workspace workspace_;
};

}  // namespace kinalign
