// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pose.h"

namespace kinalign {

void forward_kinematics(const Skeleton& skeleton, const Pose& local, GlobalPose& global) {
  const std::size_t joints = skeleton.joints();
  global.positions.resize(joints);
  global.rotations.resize(joints);
  for (std::size_t j = 0; j < joints; ++j) {
    if (skeleton.parents[j] < 0) {
      global.positions[j] = local.local_positions[j];
      global.rotations[j] = local.local_rotations[j];
      continue;
    }
    const auto p = static_cast<std::size_t>(skeleton.parents[j]);
    global.positions[j] = global.positions[p] + global.rotations[p] * local.local_positions[j];
    global.rotations[j] = global.rotations[p] * local.local_rotations[j];
  }
}

}  // namespace kinalign
