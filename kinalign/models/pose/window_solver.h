// SPDX-License-Identifier: Apache-2.0
// Runs a model of poses on live frames with a fixed delay, for any network: the network runs over a
// window of the newest frames. If the delay covers all later frames that network and smoothing use,
// the poses equal those of PoseSolver::solve() over the whole sequence, bit by bit.
#pragma once

#include "kinalign/infer/window_network.h"
#include "kinalign/models/pose/pose_model.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace kinalign {

/// The pose of one frame.
struct FramePose {
  std::vector<Turn> rotations;  // [B] relative to the root
  Eigen::Quaternionf root = Eigen::Quaternionf::Identity();
};

class WindowSolver {
 public:
  /// `solver` must outlive this object and must not be moved. `look_ahead`: the delay of an answer
  /// in frames. It is reduced to the number of later frames that network and smoothing use.
  WindowSolver(const PoseSolver& solver, std::size_t look_ahead);

  std::size_t look_ahead() const { return ahead_; }
  /// The largest useful look_ahead; empty if the network uses the whole sequence.
  static std::optional<std::size_t> most_ahead(const PoseModel& model);

  /// Takes frame `t` of `nodes`, which must follow the frame of the last call. Returns the pose of
  /// the frame look_ahead() frames earlier; empty if there is no such frame yet.
  std::optional<FramePose> step(const NodeFrames& nodes, std::size_t t);
  /// Call when no further frames come: returns the next remaining pose; empty if all are answered.
  std::optional<FramePose> finish();

 private:
  std::optional<FramePose> pose_at(std::size_t row);

  const PoseSolver* solver_;
  /// Number of later and of earlier frames in the window, seen from the answered frame.
  std::size_t ahead_, behind_;
  PoseFeatureMaker maker_;
  std::vector<float> rows_;               // [window,C] standardised channels
  std::deque<Eigen::Quaternionf> roots_;  // the root's rotation in each frame of the window
  std::size_t next_ = 0;                  // the row of the window that is answered next
  WindowNetwork network_;
};

}  // namespace kinalign
