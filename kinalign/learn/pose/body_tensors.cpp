// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/body_tensors.h"

#include "kinalign/learn/tensors.h"
#include "kinalign/models/pose/pose_metrics.h"

#include <cstring>

namespace kinalign {

// turns_of() and tensor_of() copy bytes, so a Turn must be nine numbers without padding.
static_assert(sizeof(Turn) == 9 * sizeof(float));

torch::Tensor rotations_of(const torch::Tensor& answers) {
  constexpr double least = 1e-6;
  const std::int64_t bones = answers.size(2) / 6;
  const auto identity =
      torch::tensor(std::vector<float>(six_of_identity.begin(), six_of_identity.end()))
          .to(answers.device());
  const auto six = answers.reshape({answers.size(0), answers.size(1), bones, 6}) + identity;
  // norm() has the gradient 0 at 0, whereas sqrt() of a sum of squares has no gradient there.
  const auto unit = [&](const torch::Tensor& x) { return x / (x.norm(2, {-1}, true) + least); };
  // The steps are those of turn_of_six(), so that training and use agree.
  const auto a = unit(six.slice(3, 0, 3)), second = six.slice(3, 3, 6);
  const auto b = unit(second - (a * second).sum(-1, true) * a);
  return torch::stack({a, b, torch::cross(a, b, -1)}, 3);
}

std::vector<Turn> turns_of(const torch::Tensor& rotations) {
  const std::vector<float> values = values_of(rotations);
  std::vector<Turn> out;
  for (std::size_t at = 0; at < values.size(); at += 9) {
    out.emplace_back(Eigen::Map<const Turn>(&values[at]));
  }
  return out;
}

torch::Tensor tensor_of(const std::vector<Turn>& turns, const std::vector<std::int64_t>& shape) {
  auto out = torch::empty(shape, torch::kFloat32);
  std::memcpy(out.data_ptr<float>(), turns.data(), turns.size() * sizeof(Turn));
  return out;
}

torch::Tensor metres_of(const torch::Tensor& vectors) {
  return (vectors.pow(2).sum(-1) + 1e-10).sqrt();
}

/// Finds the bone that rotates each joint's offset (its carrier), and the path to each scored
/// joint.
BodyTensors::BodyTensors(const PoseBody& body, torch::Device device)
    : bones_(whole(body.bones.size())) {
  const Skeleton& skeleton = body.skeleton;
  const std::size_t joints = skeleton.joints();
  std::vector<std::int64_t> carriers;
  std::vector<float> paths;
  std::int64_t scored = 0;
  for (std::size_t j = 1; j < joints; ++j) {
    const int bone = body.turned_by[static_cast<std::size_t>(skeleton.parents[j])];
    carriers.push_back(bone < 0 ? whole(body.bones.size()) : bone);
    if (!is_scored_joint(skeleton.joint_names[j])) continue;
    ++scored;
    // One row of the matrix: it sums the rotated offsets from the root to one joint.
    std::vector<float> path(joints - 1, 0.0F);
    for (std::size_t at = j; at != 0; at = static_cast<std::size_t>(skeleton.parents[at])) {
      path[at - 1] = 1.0F;
    }
    paths.insert(paths.end(), path.begin(), path.end());
  }
  carriers_ = torch::tensor(carriers, torch::kInt64).to(device);
  paths_ = to_torch(paths, {scored, whole(joints) - 1}).to(device);
}

// Without a rotation of the root the identity is used; all positions are then in the root's space.
torch::Tensor BodyTensors::places_of(const torch::Tensor& rotations,
                                     const torch::Tensor& offsets) const {
  auto all = rotations;
  if (all.size(2) == bones_) {
    const auto identity = torch::eye(3, all.options()).expand({all.size(0), all.size(1), 1, 3, 3});
    all = torch::cat({all, identity}, 2);
  }
  // All offsets are rotated by their carriers at once. One matrix product then sums the paths, so
  // no loop over joints is needed.
  const auto carriers = all.index_select(2, carriers_);
  const auto below_root = offsets.slice(1, 1).unsqueeze(1).unsqueeze(-1);  // [B,1,J-1,3,1]
  return torch::matmul(paths_, (carriers * below_root).sum(-2));
}

}  // namespace kinalign
