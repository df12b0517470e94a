// SPDX-License-Identifier: Apache-2.0
// A real skeleton for joints whose bones have constant lengths: what a BVH needs.
#pragma once

#include "kinalign/motion/clip.h"

#include <span>
#include <string>
#include <vector>

namespace kinalign {

struct PointBody {
  std::vector<std::string> names;  // [J]
  std::vector<int> parents;        // [J] one root alone
};

/// A clip whose joints lie where `positions` [T,J,3] m says. The rest pose is a T-pose that faces
/// +z. A joint with several children has between itself and each child one more joint in the same
/// place, named "<child>Root", which turns that bone alone. Twist about a bone is what its parent
/// has: points do not show it. Bone lengths are those of the first frame. Fails where the parents
/// are no tree with one root.
Result<Clip> skeleton_of_points(const PointBody& body, std::span<const float> positions, Time start,
                                double rate_hz);

}  // namespace kinalign
