// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/rotation.h"

#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace kinalign;

namespace {

Quat by_library(const Vec3& v) {
  const double angle = v.norm();
  if (angle == 0.0) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, v / angle));
}

}  // namespace

TEST_CASE("the series agree with the C library") {
  for (int i = 0; i <= 10000; ++i) {
    const double x = std::numbers::pi / 2 * i / 10000.0, y = x * x, t = i / 10000.0;
    CHECK(std::abs(cosine(y) - std::cos(x)) <= 5e-16);
    CHECK(std::abs(x * sine_ratio(y) - std::sin(x)) <= 4e-16);
    CHECK(std::abs(t * arctangent_ratio(t * t) - std::atan(t)) <= 4e-16);
  }
}

TEST_CASE("a rotation vector becomes its rotation") {
  for (const Vec3& v : awkward_vectors()) {
    CAPTURE(v.transpose());
    const Quat q = rotation(v);
    CHECK(std::abs(q.norm() - 1.0) <= 2e-15);
    CHECK(angle_between(q, by_library(v)) <= 1e-14);
  }
}

TEST_CASE("a rotation vector up to half a turn comes back from its rotation") {
  for (const Vec3& v : awkward_vectors()) {
    CAPTURE(v.transpose());
    if (v.norm() < std::numbers::pi - 1e-12) {
      CHECK((rotation_vector(rotation(v)) - v).norm() <= 2e-15 * (1.0 + v.norm()));
    } else {
      const Vec3 shorter = rotation_vector(rotation(v));
      CHECK(shorter.norm() <= std::numbers::pi + 1e-15);
      CHECK(angle_between(rotation(shorter), rotation(v)) <= 1e-14);
    }
  }
}

TEST_CASE("a tiny rotation vector keeps its digits") {
  const Vec3 v(1e-9, -2e-12, 3e-15);
  CHECK((rotation_vector(rotation(v)) - v).norm() <= 1e-24);
}

TEST_CASE("both quaternions of a rotation have one rotation vector") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Quat q = random_rotation(random);
    CHECK(rotation_vector(q) == rotation_vector(Quat(-q.coeffs())));
    CHECK(angle_between(rotation(rotation_vector(q)), q) <= 4e-15);
  }
}
