// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_model.h"

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

// The weights are binomial. Matrices are averaged and not quaternions, because q and -q are the
// same rotation.
void smooth_turns(std::size_t bones, std::vector<Turn>& rotations) {
  static constexpr std::array<float, 5> weights{1.0F, 4.0F, 6.0F, 4.0F, 1.0F};
  const std::vector<Turn> before = rotations;
  const auto frames = static_cast<std::ptrdiff_t>(bones == 0 ? 0 : rotations.size() / bones);
  for (std::ptrdiff_t t = 0; t < frames; ++t) {
    for (std::size_t b = 0; b < bones; ++b) {
      Turn sum = Turn::Zero();
      for (std::ptrdiff_t i = 0; i < 5; ++i) {
        const auto u =
            static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(t + i - 2, 0, frames - 1));
        sum += weights[static_cast<std::size_t>(i)] / 16.0F * before[u * bones + b];
      }
      rotations[static_cast<std::size_t>(t) * bones + b] = turned_back_to_rotation(sum);
    }
  }
}

Result<PoseSolver> PoseSolver::make(PoseModel model) {
  Network network = KA_TRY(network_of_body(model, model.layout.channels(), model.layout.answers()));
  return PoseSolver(std::move(model), std::move(network));
}

PoseSolver::PoseSolver(PoseModel model, Network network)
    : model_(std::move(model)), network_(std::move(network)) {}

SolvedPose PoseSolver::answer(const NodeFrames& nodes) {
  PoseFeatures features = pose_features(model_.layout, nodes);
  standardise(model_.input_mean, model_.input_scale, features.input);
  std::vector<float> answers;
  network_.run(features.input, nodes.frames(), workspace_, answers);
  SolvedPose out{.rotations = {}, .root = std::move(features.root)};
  out.rotations.reserve(answers.size() / 6);
  for (std::size_t at = 0; at + 6 <= answers.size(); at += 6) {
    out.rotations.push_back(turn_of_answer(&answers[at]));
  }
  return out;
}

SolvedPose PoseSolver::solve(const NodeFrames& nodes) {
  SolvedPose out = answer(nodes);
  if (model_.smoothing) smooth_turns(model_.layout.bones.size(), out.rotations);
  return out;
}

Clip PoseSolver::clip(const NodeFrames& nodes, Time start) {
  const SolvedPose pose = solve(nodes);
  return {model_.body.skeleton,
          clip_frames(model_.body, pose.rotations, pose.root, model_.layout.rate_hz, start)};
}

}  // namespace kinalign
