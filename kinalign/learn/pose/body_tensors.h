// SPDX-License-Identifier: Apache-2.0
// Rotations and positions of a body as tensors with gradients. The values equal those of
// pose_body.h.
#pragma once

#include "kinalign/models/pose/pose_body.h"

#include <torch/torch.h>

#include <vector>

namespace kinalign {

/// The rotations [B,T,bones,3,3] for a network's outputs [B,T,6 bones]. The matrices are
/// transposed: row k is column k of the rotation, because Turn is column-major.
torch::Tensor rotations_of(const torch::Tensor& answers);

/// A copy of all rotations in one list.
std::vector<Turn> turns_of(const torch::Tensor& rotations);
/// `turns` as a tensor of `shape` [...,3,3].
torch::Tensor tensor_of(const std::vector<Turn>& turns, const std::vector<std::int64_t>& shape);

/// Lengths of vectors [...,3] m, with a finite gradient at 0.
torch::Tensor metres_of(const torch::Tensor& vectors);

/// Computes positions of joints from rotations. It knows the bone that rotates each joint's offset
/// (its carrier), and the path from the root to each scored joint.
class BodyTensors {
 public:
  BodyTensors(const PoseBody& body, torch::Device device);

  /// Positions [B,T,S,3] m, relative to the root, of the joints that position errors count
  /// (is_scored_joint()). `rotations`: in the form of rotations_of(), either of the bones relative
  /// to the root, or of the bones and then the root in any one space. `offsets` [B,J,3] m.
  torch::Tensor places_of(const torch::Tensor& rotations, const torch::Tensor& offsets) const;

 private:
  std::int64_t bones_;
  /// [J-1] index of the bone that carries joint j+1; number of bones: the root.
  torch::Tensor carriers_;
  torch::Tensor paths_;  // [S,J-1] 1 if the offset of joint j+1 is on the path to the scored joint
};

}  // namespace kinalign
