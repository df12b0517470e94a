// SPDX-License-Identifier: Apache-2.0
// Gives the rotations of all people the same zero, which is the pose with rotation 0. A motion
// capture system calibrates each person separately, so the same bone name has different directions:
// in upright persons the pelvis is up to 24 degrees off the vertical, the head up to 57. Here the
// upright stand is the identity for root, trunk and head. Limbs keep their zero, the direction of
// their bone. Positions of joints do not change.
#pragma once

#include "kinalign/motion/arrays.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// Averages over frames in which a person stands upright, from all takes of that person.
class UprightFrames {
 public:
  /// `joint_names` [J]: CMU's names; joint 0 is the root.
  explicit UprightFrames(const std::vector<std::string>& joint_names);

  /// Counts a frame if the head is above the root within 20 degrees of the vertical. `rotations`
  /// [J]: global. `root_to_head`: m.
  void add(std::span<const Eigen::Matrix3d> rotations, const Vec3& root_to_head);

  std::size_t count() const { return count_; }

  /// For each joint [J] the rotation X that changes its zero: its rotation G becomes G X. Needs at
  /// least one frame. The heading of the root is kept.
  std::vector<Eigen::Matrix3d> turns() const;

 private:
  std::vector<bool> in_trunk_;              // [J] true: the joint belongs to root, trunk or head
  std::vector<Eigen::Matrix3d> from_root_;  // [J] sums of the rotations relative to the root
  Vec3 vertical_ = Vec3::Zero();            // sum of the vertical in the root's space
  std::size_t count_ = 0;
};

/// The rest offsets for the changed zeros: each offset is rotated by the transposed X of its
/// parent.
std::vector<Vec3> turned_offsets(const std::vector<int>& parents,
                                 const std::vector<Vec3>& rest_offsets,
                                 const std::vector<Eigen::Matrix3d>& turns);

}  // namespace kinalign
