// SPDX-License-Identifier: Apache-2.0
// Makes a skeleton with rotations from joints with constant bone lengths, as a BVH file needs it.
#pragma once

#include "kinalign/motion/clip.h"

#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The tree of the points. Order does not matter: a child may come before its parent.
struct PointBody {
  std::vector<std::string> names;  // [J]
  std::vector<int> parents;        // [J] exactly one root
};

/// A clip whose joints have the positions `positions` [T,J,3] m. The rest pose is a T-pose that
/// faces +z. If a joint has several children, an extra joint at the same place, named
/// "<child>Root", turns each child's bone. Points do not show the twist about a bone, so a bone
/// takes the twist of its parent. Bone lengths are those of the first frame. Fails if the parents
/// are not a tree with one root.
Result<Clip> skeleton_of_points(const PointBody& body, std::span<const float> positions, Time start,
                                double rate_hz);

}  // namespace kinalign
