// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/leg.h"

#include "tests/about.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr LegBones bones{0.45, 0.40};

Vec3 knee_of(const BentLeg& leg, const Vec3& hip) {
  return hip + leg.thigh * Vec3(0, -bones.thigh, 0);
}
Vec3 ankle_of(const BentLeg& leg, const Vec3& hip) {
  return knee_of(leg, hip) + leg.shank * Vec3(0, -bones.shank, 0);
}

}  // namespace

TEST_CASE("a leg that hangs straight down is at rest") {
  const BentLeg leg = reach(bones, {0, 1, 0}, {0, 0.15, 0}, Vec3::UnitZ());
  CHECK(leg.knee < 1e-6);
  CHECK(angle_between(leg.thigh, Quat::Identity()) < 1e-6);
}

TEST_CASE("a knee bent at a right angle stands in front of the line from hip to ankle") {
  const double d = std::hypot(bones.thigh, bones.shank);
  const BentLeg leg = reach(bones, {0, 1, 0}, {0, 1 - d, 0}, Vec3::UnitZ());
  CHECK(leg.knee == about(std::numbers::pi / 2));
  // The height of a right triangle above its longest side.
  CHECK(knee_of(leg, {0, 1, 0}).z() == about(bones.thigh * bones.shank / d));
  CHECK(std::abs(knee_of(leg, {0, 1, 0}).x()) < 1e-12);
}

TEST_CASE("whatever the ankle within reach, the leg ends there, the knee bends about x alone") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share(0.1, 0.999);
    const Vec3 hip(0.1, 0.9, -0.2), forward = random_direction(random);
    const Vec3 ankle = hip + share(random) * 0.85 * random_direction(random);
    const BentLeg leg = reach(bones, hip, ankle, forward);
    CHECK((ankle_of(leg, hip) - ankle).norm() < 1e-9);
    CHECK(leg.knee > 0.0);
    const Quat bent(Eigen::AngleAxisd(leg.knee, Vec3::UnitX()));
    CHECK(angle_between(leg.thigh.conjugate() * leg.shank, bent) < 1e-12);
    // The knee is on the side that was asked for.
    const Vec3 way = (ankle - hip).normalized();
    const Vec3 across = forward - forward.dot(way) * way;
    CHECK((knee_of(leg, hip) - hip).dot(across) > 0.0);
  }
}

TEST_CASE("an ankle out of reach is reached for with a straight leg") {
  const BentLeg leg = reach(bones, Vec3::Zero(), {0, -2, 0}, Vec3::UnitZ());
  CHECK(leg.knee == about(0.0));
  CHECK((ankle_of(leg, Vec3::Zero()) - Vec3(0, -0.85, 0)).norm() < 1e-6);
}
