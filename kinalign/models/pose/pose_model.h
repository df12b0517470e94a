// SPDX-License-Identifier: Apache-2.0
// A model that estimates a person's pose from inertial nodes: its network and all settings needed
// to use it. The file's layout: docs/formats/model.md.
#pragma once

#include "kinalign/infer/network.h"
#include "kinalign/models/pose/body_model.h"
#include "kinalign/models/pose/pose_features.h"

#include <string>
#include <vector>

namespace kinalign {

struct PoseModel : BodyModel {  // task "pose"
  PoseLayout layout;
};

/// The bytes of a model's file. The same model gives the same bytes.
std::string write_pose_model(const PoseModel& model);

/// Fails if the file is not a model of this task or its parts do not fit together.
Result<PoseModel> read_pose_model(std::string_view bytes, const std::string& name);

/// `root` is the orientation of the root's node: a network for nodes does not estimate it.
struct SolvedPose {
  std::vector<Turn> rotations;           // [T,B] relative to the root
  std::vector<Eigen::Quaternionf> root;  // [T] rotation in the world
};

/// A model ready for whole sequences. It can be used by one thread at a time.
class PoseSolver {
 public:
  static Result<PoseSolver> make(PoseModel model);

  const PoseModel& model() const { return model_; }

  /// Estimates the pose of a sequence. `nodes`: the layout's nodes at the layout's rate.
  SolvedPose solve(const NodeFrames& nodes);
  /// Estimates the pose of a sequence without smoothing.
  SolvedPose answer(const NodeFrames& nodes);
  /// A skeleton with constant bones (clip_frames()). The first frame has the stamp `start`.
  Clip clip(const NodeFrames& nodes, Time start);

  /// Uses a person's own body from now on: the model's skeleton with other lengths (own_body.h).
  void use_body(Skeleton body) { model_.body.skeleton = std::move(body); }

 private:
  friend class WindowSolver;
  PoseSolver(PoseModel model, Network network);

  PoseModel model_;
  Network network_;
  Workspace workspace_;
};

/// Smooths rotations [T,B] in place: the mean of five frames with weights 1, 4, 6, 4, 1, converted
/// back to a rotation. Beyond both ends the first and the last frame are repeated.
void smooth_turns(std::size_t bones, std::vector<Turn>& rotations);

}  // namespace kinalign
