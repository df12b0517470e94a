// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_body.h"

#include "tests/models/pose/pose_people.h"
#include "tests/seeds.h"

#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace kinalign;

TEST_CASE("six numbers of a rotation give the rotation, at any length of its columns") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Turn turn = random_turn(random).toRotationMatrix();
    std::array<float, 6> six{};
    for (std::size_t k = 0; k < 6; ++k) six[k] = turn.data()[k] * (k < 3 ? 0.7F : 3.0F);
    for (std::size_t k = 0; k < 3; ++k) six[3 + k] += 0.4F * six[k];
    // turn_of_six adds 1e-6 to the lengths by which it divides.
    CHECK((turn_of_six(six.data()) - turn).norm() < 1e-5F);
  }
}

TEST_CASE("a body's bones and joints fit together") {
  const PoseBody body = pose_body(test_offsets());
  CHECK(validate(body));
  CHECK(body.skeleton.joints() == 27);
  CHECK(body.turned_by[0] == -1);
  PoseBody other = body;
  other.turned_by[3] = 15;
  CHECK(to_string(validate(other).error()) ==
        "expected a bone for each joint below the root, found another list of bones");
}

TEST_CASE("positions are those of forward kinematics, and the lowest joint stands on the floor") {
  const PoseBody body = pose_body(test_offsets());
  const std::size_t joints = body.skeleton.joints(), bones = body.bones.size();
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    constexpr std::size_t frames = 3;
    const auto rotations = random_turns(frames * bones, random);
    std::vector<Eigen::Quaternionf> root;
    for (std::size_t t = 0; t < frames; ++t) root.push_back(random_turn(random));
    const ClipFrames clip = clip_frames(body, rotations, root, 30.0, Time{});
    std::vector<double> global(frames * joints * 3);
    forward_kinematics(body.skeleton, clip, global);
    const auto about_root = bone_positions(body, body.skeleton.rest_offsets, rotations);
    for (std::size_t t = 0; t < frames; ++t) {
      double lowest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < joints; ++j) {
        const std::size_t i = t * joints + j;
        const Vec3 there = vec3(global, i) - vec3(global, t * joints);
        const Eigen::Vector3f here =
            root[t] * Eigen::Map<const Eigen::Vector3f>(&about_root[3 * i]);
        CHECK((there - here.cast<double>()).norm() < 1e-6);  // floats of 1 m, eight bones
        lowest = std::min(lowest, vec3(global, i).y());
      }
      CHECK(std::abs(lowest) < 1e-6);
    }
    CHECK(clip.stamps[1] - clip.stamps[0] == Duration{33'333'333});
  }
}
