// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_pose.h"

#include <utility>

namespace kinalign {

LivePose::LivePose(const PoseSolver& solver, const LiveWornOptions& options, std::size_t look_ahead)
    : worn_(solver.model().layout, solver.model().body.skeleton, options),
      solver_(solver, look_ahead) {}

void LivePose::advance(Time now, std::vector<LivePoseFrame>& out) {
  // A pose from nodes needs no other device, so the condition for other devices is always true.
  worn_.advance(
      now, [](Time) { return true; }, ready_);
  answer(out);
}

void LivePose::finish(std::vector<LivePoseFrame>& out) {
  worn_.finish(ready_);
  answer(out);
  while (auto pose = solver_.finish()) emit(*std::move(pose), out);
}

void LivePose::answer(std::vector<LivePoseFrame>& out) {
  for (const LiveWornFrame& frame : ready_) {
    pending_.push_back({frame.stamp, frame.nodes.valid});
    if (auto pose = solver_.step(frame.nodes, 0)) emit(*std::move(pose), out);
  }
  ready_.clear();
}

void LivePose::emit(FramePose pose, std::vector<LivePoseFrame>& out) {
  out.push_back({pending_.front().stamp, std::move(pose), std::move(pending_.front().valid)});
  pending_.pop_front();
}

}  // namespace kinalign
