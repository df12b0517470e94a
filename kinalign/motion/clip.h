// SPDX-License-Identifier: Apache-2.0
// A skeleton and its motion. Metres, right-handed, y up; rotations w,x,y,z; arrays row-major.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/wire/time.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// The end of a leaf joint: a position without a rotation.
struct EndSite {
  int parent = 0;              // index of its joint
  Vec3 offset = Vec3::Zero();  // m, in the parent's space
};

/// Joints, each parent before its children.
struct Skeleton {
  std::vector<std::string> joint_names;  // [J] each name once
  std::vector<int> parents;              // [J] parents[j] < j; -1: a root
  std::vector<Vec3> rest_offsets;        // [J] m, from the parent, in the parent's space
  std::vector<EndSite> end_sites;        // not among the joints; in the order of the file

  std::size_t joints() const { return parents.size(); }
};

/// Fails if names repeat, sizes differ or a parent does not come before its child.
Result<void> validate(const Skeleton& skeleton);

/// T frames of a skeleton with J joints: a part of a clip, or all of it.
struct ClipFrames {
  std::vector<Time> stamps;             // [T] strictly rising
  std::vector<double> local_positions;  // [T,J,3] m, each joint in its parent's space
  std::vector<double> local_rotations;  // [T,J,4] unit, each joint in its parent's space

  std::size_t size() const { return stamps.size(); }
};

struct Clip {
  Skeleton skeleton;
  ClipFrames frames;
};

}  // namespace kinalign
