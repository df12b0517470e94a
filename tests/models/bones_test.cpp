// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/bones.h"

#include "tests/models/bodies.h"

#include "kinalign/models/joint_names.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace kinalign;

namespace {

float bone(const std::vector<float>& positions, std::size_t joints, std::size_t frame,
           std::size_t a, std::size_t b) {
  const float* p = &positions[(frame * joints + a) * 3];
  const float* q = &positions[(frame * joints + b) * 3];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

}  // namespace

TEST_CASE("bones: lengths are medians over time, and the means of both sides") {
  const std::vector<int> parents{-1, 0, 0};
  // Bones of 1, 1, 9 to the left and of 3 to the right: (1 + 3) / 2.
  std::vector<float> positions;
  for (const float left : {1.0F, 1.0F, 9.0F}) {
    positions.insert(positions.end(), {0, 0, 0, left, 0, 0, 0, -3, 0});
  }
  CHECK(typical_lengths(parents, {0, 2, 1}, positions) == std::vector<float>{0, 2, 2});
  CHECK(typical_lengths(parents, {0, 1, 2}, positions) == std::vector<float>{0, 1, 3});
  CHECK(typical_lengths(parents, {0, 2, 1}, {}) == std::vector<float>{0, 0, 0});
}

TEST_CASE("bones: imposed lengths are exact and joints move little") {
  const auto names = body_joint_names();
  const auto parents = kinect_parents_of(names);
  const auto partners = mirror_partners(names);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    JointFrames body = moving_body(15, seed);
    const auto lengths = typical_lengths(parents, partners, body.positions);
    const auto before = body.positions;
    float worst_bone = 0.0F;
    for (std::size_t t = 0; t < 15; ++t) {
      for (std::size_t j = 1; j < body.joints; ++j) {
        const float length = bone(before, body.joints, t, j, static_cast<std::size_t>(parents[j]));
        worst_bone = std::max(worst_bone, std::abs(length - lengths[j]));
      }
    }
    impose_lengths(parents, lengths, body.positions);
    double moved = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      moved += std::abs(static_cast<double>(body.positions[i]) - static_cast<double>(before[i]));
    }
    for (std::size_t t = 0; t < 15; ++t) {
      for (std::size_t j = 1; j < body.joints; ++j) {
        const float length =
            bone(body.positions, body.joints, t, j, static_cast<std::size_t>(parents[j]));
        CHECK(std::abs(length - lengths[j]) < 1e-6F);  // float's rounding of 1.6 m
      }
    }
    CHECK(worst_bone > 0.02F);
    CHECK(moved / static_cast<double>(before.size()) < 0.5 * static_cast<double>(worst_bone));
  }
}

TEST_CASE("bones: a body whose bones have their lengths stays") {
  const auto parents = kinect_parents_of(body_joint_names());
  std::vector<float> positions;
  for (const auto& joint : standing_body) {
    positions.insert(positions.end(), joint.begin(), joint.end());
  }
  const auto before = positions;
  const auto lengths = typical_lengths(parents, mirror_partners(body_joint_names()), positions);
  impose_lengths(parents, lengths, positions);
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(std::abs(positions[i] - before[i]) < 1e-6F);
}

TEST_CASE(
    "bones: joints in one place are parted upwards, and a child may stand before its parent") {
  std::vector<float> positions{1, 2, 3, 1, 2, 3};
  impose_lengths({1, -1}, {0.5F, 0.0F}, positions);
  CHECK(positions == std::vector<float>{1, 2.5F, 3, 1, 2, 3});
}
