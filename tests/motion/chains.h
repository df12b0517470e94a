// SPDX-License-Identifier: Apache-2.0
// Skeletons of random shapes in random poses, for tests.
#pragma once

#include "tests/motion/rotations.h"

#include "kinalign/motion/clip.h"

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>

namespace kinalign {

struct Chain {
  Skeleton skeleton;
  ClipFrames frames;
};

/// Joints with random parents, several roots among them, in random poses.
inline Chain random_chain(std::size_t joints, std::size_t frames, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Chain chain;
  for (std::size_t j = 0; j < joints; ++j) {
    const auto parent = static_cast<int>(random() % (j + 1)) - (random() % 5 == 0 ? 1 : 0);
    chain.skeleton.parents.push_back(j == 0 ? -1 : std::min(parent, static_cast<int>(j) - 1));
    chain.skeleton.joint_names.push_back("joint" + std::to_string(j));
  }
  chain.skeleton.rest_offsets.assign(joints, Vec3::Zero());
  chain.frames.stamps.resize(frames);
  chain.frames.local_rotations.resize(4 * joints * frames);
  for (std::size_t i = 0; i < joints * frames; ++i) {
    put_quat(chain.frames.local_rotations, i, random_rotation(random));
    for (int k = 0; k < 3; ++k) chain.frames.local_positions.push_back(normal(random));
  }
  return chain;
}

}  // namespace kinalign
