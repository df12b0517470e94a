// SPDX-License-Identifier: Apache-2.0
// A model of poses that answers frame by frame, some frames late, whatever its network: the network
// runs over a window of the newest frames. With all the later frames that network and smoothing
// see, the answers are those of PoseSolver::solve() over the whole sequence, bit by bit.
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
  std::vector<Turn> rotations;  // [B] against the root
  Eigen::Quaternionf root = Eigen::Quaternionf::Identity();
};

class WindowSolver {
 public:
  /// `solver` must live longer and must not be moved. `look_ahead`: frames that an answer waits
  /// for; more than network and smoothing see are of no use, and not waited for.
  WindowSolver(const PoseSolver& solver, std::size_t look_ahead);

  std::size_t look_ahead() const { return ahead_; }
  /// The most that is of use; nothing where the network sees the whole sequence.
  static std::optional<std::size_t> most_ahead(const PoseModel& model);

  /// Takes frame `t` of `nodes`, the frame after the one before. The pose of the frame look_ahead()
  /// earlier; absent before there is one.
  std::optional<FramePose> step(const NodeFrames& nodes, std::size_t t);
  /// No further frames come: the next pose of those that are left.
  std::optional<FramePose> finish();

 private:
  std::optional<FramePose> pose_at(std::size_t row);

  const PoseSolver* solver_;
  std::size_t ahead_, behind_;  // frames of the window on both sides of the one that is answered
  PoseFeatureMaker maker_;
  std::vector<float> rows_;               // [window,C] channels, standardised
  std::deque<Eigen::Quaternionf> roots_;  // [window]
  std::size_t next_ = 0;                  // row of the window that is answered next
  WindowNetwork network_;
  std::size_t run_ = 0;  // rows of the window that the network has seen
};

}  // namespace kinalign
