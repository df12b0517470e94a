// SPDX-License-Identifier: Apache-2.0
// A body's rotations and places as tensors, with gradients. They equal those of pose_body.h.
#pragma once

#include "kinalign/models/pose/pose_body.h"

#include <torch/torch.h>

#include <vector>

namespace kinalign {

/// The rotations [B,T,bones,3,3] of a network's answers [B,T,6 bones]: row k is column k of the
/// rotation.
torch::Tensor rotations_of(const torch::Tensor& answers);

/// A copy of rotations, one behind the other.
std::vector<Turn> turns_of(const torch::Tensor& rotations);
/// `turns` as a tensor of `shape` [...,3,3].
torch::Tensor tensor_of(const std::vector<Turn>& turns, const std::vector<std::int64_t>& shape);

/// Lengths of vectors [...,3] m, with a gradient at 0.
torch::Tensor metres_of(const torch::Tensor& vectors);

/// Knows which bone carries which joint, and the way from the root to each joint that is scored.
class BodyTensors {
 public:
  BodyTensors(const PoseBody& body, torch::Device device);

  /// Positions [B,T,S,3] m of the joints that position errors count (is_scored_joint()), about the
  /// root. `rotations` as rotations_of() gives them: of the bones against the root, or in any one
  /// space with the root's behind them. `offsets` [B,J,3] m.
  torch::Tensor places_of(const torch::Tensor& rotations, const torch::Tensor& offsets) const;

 private:
  std::int64_t bones_;
  torch::Tensor carriers_;  // [J-1] whose rotation carries joint j+1; bones: the root's
  torch::Tensor paths_;     // [S,J-1] 1: the offset of joint j+1 leads to the scored joint
};

}  // namespace kinalign
