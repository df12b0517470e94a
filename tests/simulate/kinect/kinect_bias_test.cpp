// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_bias.h"

#include "tests/seeds.h"

#include "kinalign/simulate/kinect/kinect_noise.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>

using namespace kinalign;

namespace {

using Offsets = std::array<Vec3, kinect_joint_count>;

/// The offsets that the bias adds to the joints of a body with that heading, m.
Offsets bias_of(const BodyHeading& heading, const KinectIds& ids) {
  const std::array<KinectTick, 1> tick{};
  KinectScene scene;
  scene.ticks = tick;
  scene.headings = {heading};
  std::array<double, 3 * kinect_joint_count> joints{};
  add_kinect_bias(scene, ids, joints);
  Offsets offsets;
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    offsets[j] = vec3(std::span<const double>(joints), j);
  }
  return offsets;
}

/// The offsets of a body turned by `yaw` (rad), minus those of one that faces the camera, m.
Offsets turned_by(double yaw, bool left_is_far, const KinectIds& ids) {
  Offsets offsets = bias_of({.yaw = yaw, .left_is_far = left_is_far}, ids);
  const Offsets facing = bias_of({}, ids);
  for (std::size_t j = 0; j < kinect_joint_count; ++j) offsets[j] -= facing[j];
  return offsets;
}

}  // namespace

TEST_CASE("offsets go round with the body") {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.7, Vec3(0.1, 0.9, 0.2).normalized()));
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    const Offsets facing = bias_of({}, {.seed = seed});
    const Offsets turned = bias_of({.axes = turn}, {.seed = seed});
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      CHECK((turned[j] - turn * facing[j]).norm() < 1e-12);
    }
  }
}

TEST_CASE("a joint's offset goes with that of the joint that it hangs on, as was measured") {
  constexpr double people = 4000.0;
  for (const KinectJoint j : {hip_left, foot_right, wrist_left, spine_mid}) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const KinectJointNoise& source = kinect_joint_noise()[noise.source];
    double together = 0.0;
    for (std::uint64_t person = 0; person < 4000; ++person) {
      const Offsets offsets = bias_of({}, {.person = person});
      together += (offsets[j] - noise.offset).dot(offsets[noise.source] - source.offset) / people;
    }
    // 0.45 of the sd between takes does not depend on their poses.
    const double shared = noise.person * source.person + 0.45 * 0.45 * noise.take * source.take;
    CAPTURE(kinect_joints[j]);
    CHECK(noise.kinship > 0.3);
    CHECK(std::abs(together / shared - noise.kinship) < 0.06);  // five sd of 12,000 products
  }
}

TEST_CASE(
    "a body that stands sideways is off by 6 cm at its trunk, by 5 and 4 at far, near limbs") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    for (const bool left_is_far : {true, false}) {
      const Offsets turned = turned_by(std::numbers::pi / 2.0, left_is_far, {.seed = seed});
      CHECK(turned[spine_mid].norm() == doctest::Approx(0.06));
      CHECK(turned[wrist_left].norm() == doctest::Approx(left_is_far ? 0.05 : 0.04));
      CHECK(turned[wrist_right].norm() == doctest::Approx(left_is_far ? 0.04 : 0.05));
      CHECK(turned[knee_left].norm() == doctest::Approx(left_is_far ? 0.05 : 0.04));
      // At least half of it is along the optical axis.
      for (const Vec3& off : turned) CHECK(std::abs(off.z()) > 0.499 * off.norm());
    }
  }
}

TEST_CASE("a body is off by half of that at 45 degrees, from behind 1.9 times as much") {
  const auto trunk = [](double degrees) {
    return turned_by(degrees * std::numbers::pi / 180.0, true, {})[spine_mid].norm() / 0.06;
  };
  CHECK(trunk(45.0) == doctest::Approx(0.5));
  CHECK(trunk(89.9) == doctest::Approx(1.0).epsilon(1e-3));
  CHECK(trunk(90.1) == doctest::Approx(1.0).epsilon(1e-3));
  CHECK(trunk(135.0) == doctest::Approx(1.45));
  CHECK(trunk(180.0) == doctest::Approx(1.9));
}
