// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pose.h"

#include "kinalign/motion/stamps.h"

#include <cmath>

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

ClipFrames sample_frames(const Motion& motion, double rate_hz, Time first) {
  const std::size_t joints = motion.skeleton.joints();
  // Includes a frame exactly at the end, even if rounding puts the product slightly beyond it.
  const auto count = static_cast<std::size_t>(std::floor(motion.length_s * rate_hz + 1e-9)) + 1;
  ClipFrames frames;
  frames.stamps.resize(count);
  frames.local_positions.resize(3 * joints * count);
  frames.local_rotations.resize(4 * joints * count);
  Pose pose;
  for (std::size_t i = 0; i < count; ++i) {
    frames.stamps[i] = frame_stamp(first, 1e9 / rate_hz, i);
    motion.pose_at(static_cast<double>(i) / rate_hz, pose);
    for (std::size_t j = 0; j < joints; ++j) {
      vec3(frames.local_positions, i * joints + j) = pose.local_positions[j];
      put_quat(frames.local_rotations, i * joints + j, pose.local_rotations[j]);
    }
  }
  return frames;
}

}  // namespace kinalign
