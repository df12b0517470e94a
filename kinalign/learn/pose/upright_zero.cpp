// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/upright_zero.h"

#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

namespace kinalign {

namespace {

constexpr double most_lean_deg = 20.0;
constexpr std::array<std::string_view, 8> trunk{"lowerback", "upperback", "thorax",    "lowerneck",
                                                "upperneck", "head",      "lclavicle", "rclavicle"};

/// The rotation nearest to a matrix.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turned_v = parts.matrixV();
  if ((parts.matrixU() * turned_v.transpose()).determinant() < 0.0) turned_v.col(2) *= -1.0;
  return parts.matrixU() * turned_v.transpose();
}

}  // namespace

UprightFrames::UprightFrames(const std::vector<std::string>& joint_names)
    : from_root_(joint_names.size(), Eigen::Matrix3d::Zero()) {
  for (const std::string& name : joint_names) {
    in_trunk_.push_back(std::find(trunk.begin(), trunk.end(), name) != trunk.end());
  }
}

void UprightFrames::add(std::span<const Eigen::Matrix3d> rotations, const Vec3& root_to_head) {
  const double least = std::cos(most_lean_deg * std::numbers::pi / 180.0);
  if (root_to_head.y() <= least * root_to_head.norm()) return;
  ++count_;
  const Eigen::Matrix3d root_from_world = rotations[0].transpose();
  vertical_ += root_from_world.col(1);
  for (std::size_t j = 0; j < rotations.size(); ++j) {
    if (in_trunk_[j]) from_root_[j] += root_from_world * rotations[j];
  }
}

std::vector<Eigen::Matrix3d> UprightFrames::turns() const {
  std::vector<Eigen::Matrix3d> out(from_root_.size(), Eigen::Matrix3d::Identity());
  // Only the tilt of the root is removed. Its heading does not belong to the zero.
  out[0] = Quat::FromTwoVectors(Vec3::UnitY(), vertical_).toRotationMatrix();
  for (std::size_t j = 0; j < out.size(); ++j) {
    // A mean of rotations is no rotation, so the nearest rotation is used (SVD).
    if (in_trunk_[j]) out[j] = nearest_rotation(from_root_[j]).transpose() * out[0];
  }
  return out;
}

std::vector<Vec3> turned_offsets(const std::vector<int>& parents,
                                 const std::vector<Vec3>& rest_offsets,
                                 const std::vector<Eigen::Matrix3d>& turns) {
  std::vector<Vec3> out = rest_offsets;
  for (std::size_t j = 0; j < out.size(); ++j) {
    if (parents[j] < 0) continue;
    out[j] = turns[static_cast<std::size_t>(parents[j])].transpose() * rest_offsets[j];
  }
  return out;
}

}  // namespace kinalign
