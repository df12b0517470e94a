// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pose.h"

#include "tests/about.h"
#include "tests/motion/chains.h"
#include "tests/seeds.h"

#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

TEST_CASE("a pose's global positions are those of the same frame of a clip") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Chain chain = random_chain(1 + random() % 60, 1, random);
    const std::size_t joints = chain.skeleton.joints();
    Pose pose;
    for (std::size_t j = 0; j < joints; ++j) {
      pose.local_positions.emplace_back(vec3(chain.frames.local_positions, j));
      pose.local_rotations.push_back(quat(chain.frames.local_rotations, j));
    }
    GlobalPose global;
    forward_kinematics(chain.skeleton, pose, global);
    std::vector<double> expected(3 * joints);
    forward_kinematics(chain.skeleton, chain.frames, expected);
    for (std::size_t j = 0; j < joints; ++j) {
      CHECK((global.positions[j] - vec3(expected, j)).norm() < 1e-12);
    }
  }
}

TEST_CASE("rotations of a chain multiply from the root outwards") {
  const Skeleton skeleton{{"a", "b"}, {-1, 0}, {Vec3::Zero(), Vec3::UnitX()}, {}};
  const Quat first(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
  const Quat second(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  GlobalPose global;
  forward_kinematics(skeleton, {{Vec3::Zero(), Vec3::UnitX()}, {first, second}}, global);
  CHECK(angle_between(global.rotations[1], first * second) < 1e-15);
  CHECK((global.positions[1] - Vec3(std::cos(0.5), 0.0, -std::sin(0.5))).norm() < 1e-15);
}
