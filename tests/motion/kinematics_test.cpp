// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/kinematics.h"

#include "tests/motion/chains.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace kinalign;

namespace {

constexpr std::array<std::array<int, 3>, 6> orders{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

Quat by_axes(const std::array<int, 3>& order, const double* degrees) {
  Quat q = Quat::Identity();
  for (std::size_t k = 0; k < 3; ++k) {
    q = q * Eigen::AngleAxisd(degrees[k] * std::numbers::pi / 180.0, Vec3::Unit(order[k]));
  }
  return q;
}

/// [n,3] angles up to two turns, among them those at which tables and series change.
std::vector<double> awkward_angles(std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-720.0, 720.0);
  std::vector<double> angles(3 * n);
  for (auto& a : angles) {
    a = any(random);
    if (random() % 2 == 0) a = 45.0 * static_cast<double>(static_cast<int>(random() % 33) - 16);
  }
  return angles;
}

/// The same computed frame by frame and joint by joint, with matrices.
void plain(const Chain& chain, std::vector<double>& positions) {
  const std::size_t joints = chain.skeleton.joints();
  std::vector<Eigen::Isometry3d> global(joints);
  for (std::size_t i = 0; i < joints * chain.frames.size(); ++i) {
    const std::size_t j = i % joints;
    Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
    local.linear() = quat(chain.frames.local_rotations, i).toRotationMatrix();
    local.translation() = vec3(chain.frames.local_positions, i);
    const int parent = chain.skeleton.parents[j];
    global[j] = parent < 0 ? local : global[static_cast<std::size_t>(parent)] * local;
    vec3(positions, i) = global[j].translation();
  }
}

}  // namespace

TEST_CASE("a quarter turn about x, then about the new y, sends x to z") {
  const std::vector<double> angles{90, 90, 0};
  std::vector<double> q(4);
  rotations_from_euler({0, 1, 2}, {{&angles[0], &angles[1], &angles[2]}, 3, q.data(), 4}, 1);
  CHECK((quat(q, 0) * Vec3::UnitX() - Vec3(0, 1, 0)).norm() <= 1e-15);
  CHECK((quat(q, 0) * Vec3::UnitY() - Vec3(0, 0, 1)).norm() <= 1e-15);
}

TEST_CASE("euler angles up to two turns, in all six orders, agree with three axis turns") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const auto& order : orders) {
      const std::size_t n = 1 + random() % 40;
      const auto angles = awkward_angles(n, random);
      std::vector<double> q(5 * n, -7.0);  // rows of 5: the fifth must not be changed
      rotations_from_euler({order[0], order[1], order[2]},
                           {{&angles[0], &angles[1], &angles[2]}, 3, q.data(), 5}, n);
      for (std::size_t i = 0; i < n; ++i) {
        const Quat found(q[5 * i], q[5 * i + 1], q[5 * i + 2], q[5 * i + 3]);
        CHECK(angle_between(found, by_axes(order, &angles[3 * i])) <= 5e-15);
        CHECK(std::abs(found.norm() - 1.0) <= 2e-15);
        CHECK(q[5 * i + 4] == -7.0);
      }
    }
  }
}

TEST_CASE("a missing angle is zero in every block") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    auto angles = awkward_angles(40, random);
    std::vector<double> q(160), expected(160);
    rotations_from_euler({2, 0, 1}, {{&angles[0], nullptr, &angles[2]}, 3, q.data(), 4}, 40);
    for (std::size_t i = 0; i < 40; ++i) angles[3 * i + 1] = 0.0;
    rotations_from_euler({2, 0, 1}, {{&angles[0], &angles[1], &angles[2]}, 3, expected.data(), 4},
                         40);
    CHECK(q == expected);
  }
}

TEST_CASE("forward kinematics agrees with a plain loop over matrices") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t joints = 1 + random() % 30, frames = random() % 50;
    const Chain chain = random_chain(joints, frames, random);
    std::vector<double> positions(3 * joints * frames);
    auto expected = positions;
    plain(chain, expected);
    forward_kinematics(chain.skeleton, chain.frames, positions);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      CHECK(std::abs(positions[i] - expected[i]) <= 1e-13 * static_cast<double>(joints));
    }
  }
}

TEST_CASE("the blocks of a clip give the positions of the whole") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Chain chain = random_chain(7, 40, random);
    std::vector<double> whole(3 * 7 * 40);
    forward_kinematics(chain.skeleton, chain.frames, whole);
    const std::size_t cut = random() % 40;
    ClipFrames rest;
    rest.stamps.resize(40 - cut);
    const auto& all = chain.frames;
    rest.local_positions.assign(all.local_positions.begin() + static_cast<long>(cut) * 21,
                                all.local_positions.end());
    rest.local_rotations.assign(all.local_rotations.begin() + static_cast<long>(cut) * 28,
                                all.local_rotations.end());
    std::vector<double> part(3 * 7 * (40 - cut));
    forward_kinematics(chain.skeleton, rest, part);
    CHECK(part == std::vector<double>(whole.begin() + static_cast<long>(cut) * 21, whole.end()));
  }
}
