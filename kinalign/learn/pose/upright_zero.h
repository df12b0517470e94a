// SPDX-License-Identifier: Apache-2.0
// One zero for the rotations of all people. A motion capture system calibrates each person anew, so
// the same bone name is not the same direction: a pelvis lies up to 24 degrees off the vertical in
// a person who stands upright, a head up to 57. Here an upright stand is the identity for root,
// trunk and head. Limbs keep their zero, the direction of their bone. No joint moves.
#pragma once

#include "kinalign/motion/arrays.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// Frames in which a person stands upright, summed over all takes of that person.
class UprightFrames {
 public:
  /// `joint_names` [J] are CMU's; joint 0 is the root.
  explicit UprightFrames(const std::vector<std::string>& joint_names);

  /// Counts a frame if its head is within 20 degrees above its root. `rotations` [J] global,
  /// `root_to_head` m.
  void add(std::span<const Eigen::Matrix3d> rotations, const Vec3& root_to_head);

  std::size_t count() const { return count_; }

  /// For each joint the turn X [J]: its rotation G becomes G X. Needs one frame at least.
  std::vector<Eigen::Matrix3d> turns() const;

 private:
  std::vector<bool> in_trunk_;              // [J]
  std::vector<Eigen::Matrix3d> from_root_;  // [J] sums of the trunk's rotations against the root
  Vec3 vertical_ = Vec3::Zero();            // sum of the vertical in the root's space
  std::size_t count_ = 0;
};

/// Offsets turn with the bone that carries them: X of the parent, transposed, before each.
std::vector<Vec3> turned_offsets(const std::vector<int>& parents,
                                 const std::vector<Vec3>& rest_offsets,
                                 const std::vector<Eigen::Matrix3d>& turns);

}  // namespace kinalign
