// SPDX-License-Identifier: Apache-2.0
// A person's pose from live samples of the nodes: calibrates the nodes (live_worn.h) and solves a
// window of frames (window_solver.h).
#pragma once

#include "kinalign/models/pose/live_worn.h"
#include "kinalign/models/pose/window_solver.h"

#include <deque>
#include <vector>

namespace kinalign {

/// `stamp` is the time of the grid's frame, not of a sample; `valid` says which nodes had samples.
struct LivePoseFrame {
  Time stamp{};
  FramePose pose;
  std::vector<std::uint8_t> valid;  // [N] per node
};

/// Samples go in through worn(); advance() then returns the poses. The solver returns some frames
/// late, so `pending_` keeps the stamp and the validity of each frame until then.
class LivePose {
 public:
  /// `solver` must outlive this object and must not be moved. `look_ahead`: see WindowSolver.
  LivePose(const PoseSolver& solver, const LiveWornOptions& options, std::size_t look_ahead);

  LiveWorn& worn() { return worn_; }
  const LiveWorn& worn() const { return worn_; }
  std::size_t look_ahead() const { return solver_.look_ahead(); }

  /// Appends all frames that can be answered now. `now`: arrival of the newest message.
  void advance(Time now, std::vector<LivePoseFrame>& out);
  /// Call when no further samples come: appends all remaining frames.
  void finish(std::vector<LivePoseFrame>& out);

 private:
  void answer(std::vector<LivePoseFrame>& out);
  void emit(FramePose pose, std::vector<LivePoseFrame>& out);

  LiveWorn worn_;
  WindowSolver solver_;
  std::vector<LiveWornFrame> ready_;
  struct Pending {
    Time stamp{};
    std::vector<std::uint8_t> valid;
  };
  std::deque<Pending> pending_;  // frames in the solver that have no pose yet
};

}  // namespace kinalign
