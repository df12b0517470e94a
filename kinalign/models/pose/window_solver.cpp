// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/window_solver.h"

#include "kinalign/infer/shapes.h"
#include "kinalign/motion/frame_arrays.h"

#include <algorithm>

namespace kinalign {

namespace {

constexpr std::size_t smoothed_each_side = 2;  // frames on each side, used by smooth_turns()
/// Earlier frames kept if the network uses the whole sequence: two seconds at 30 Hz, six times the
/// number that Huang et al. («Deep inertial poser», SIGGRAPH Asia 2018) use.
constexpr std::size_t remembered = 60;

// frames on each side that the smoothing needs
std::size_t smoothing_rows(const PoseModel& model) {
  return model.smoothing ? smoothed_each_side : 0;
}

}  // namespace

std::optional<std::size_t> WindowSolver::most_ahead(const PoseModel& model) {
  const auto network = kinalign::look_ahead(model.architecture);
  return network ? std::optional(*network + smoothing_rows(model)) : std::nullopt;
}

WindowSolver::WindowSolver(const PoseSolver& solver, std::size_t look_ahead)
    : solver_(&solver),
      ahead_(std::min(look_ahead, most_ahead(solver.model()).value_or(look_ahead))),
      behind_(look_back(solver.model().architecture).value_or(remembered) +
              smoothing_rows(solver.model())),
      maker_(solver.model().layout),
      network_(solver.network_) {}

std::optional<FramePose> WindowSolver::step(const NodeFrames& nodes, std::size_t t) {
  const PoseModel& model = solver_->model();
  const std::size_t channels = model.layout.channels();
  const std::size_t begin = rows_.size();
  rows_.resize(begin + channels);
  const std::span<float> row = std::span(rows_).subspan(begin, channels);
  maker_.make(nodes, t, row);
  standardise(model.input_mean, model.input_scale, row);
  roots_.push_back(maker_.root());
  if (roots_.size() - next_ <= ahead_) return std::nullopt;
  return pose_at(next_);
}

std::optional<FramePose> WindowSolver::finish() {
  if (next_ == roots_.size()) return std::nullopt;
  return pose_at(next_);
}

/// Computes the pose of one row and removes rows from the window that no later frame needs.
std::optional<FramePose> WindowSolver::pose_at(std::size_t row) {
  const std::size_t bones = solver_->model().layout.bones.size();
  const std::size_t frames = roots_.size();
  const std::size_t first = row - std::min(row, smoothed_each_side);
  const std::size_t end = std::min(row + smoothed_each_side + 1, frames);
  const auto answers = network_.run(rows_, frames, frames, end);
  std::vector<Turn> turns;
  for (std::size_t at = first * bones; at < end * bones; ++at) {
    turns.push_back(turn_of_answer(&answers[6 * at]));
  }
  if (solver_->model().smoothing) smooth_turns(bones, turns);
  FramePose out;
  out.rotations = row_of(turns, row - first, bones);
  out.root = roots_[row];
  ++next_;
  while (next_ > behind_) {
    erase_first(rows_, rows_.size() / roots_.size());
    roots_.pop_front();
    network_.forget(1);
    --next_;
  }
  return out;
}

}  // namespace kinalign
