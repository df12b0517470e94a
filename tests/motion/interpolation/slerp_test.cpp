// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/slerp.h"

#include "tests/motion/interpolation/curves.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

TEST_CASE("half way between no turn and a quarter turn is an eighth") {
  const double s = std::sqrt(0.5);
  const auto half = slerp({0, 2}, {1, 0, 0, 0, s, 0, 0, s}, {1});
  CHECK(angle_between(quat(half, 0), rotation({0, 0, std::numbers::pi / 4})) <= 1e-15);
}

TEST_CASE("slerp goes the shorter way, whatever sign a knot has") {
  const Quat right = rotation({0.3, 0, 0});
  const auto out =
      slerp({0, 1}, {1, 0, 0, 0, -right.w(), -right.x(), -right.y(), -right.z()}, {0.5});
  CHECK(angle_between(quat(out, 0), rotation({0.15, 0, 0})) <= 1e-15);
}

TEST_CASE("one knot serves all stamps, and no stamps ask for nothing") {
  CHECK(slerp({5}, {0, 1, 0, 0}, {5, 5}) == std::vector<double>{0, 1, 0, 0, 0, 1, 0, 0});
  CHECK(slerp({0, 1}, {1, 0, 0, 0, 0, 1, 0, 0}, {}).empty());
}

TEST_CASE("between any two knots slerp turns at a constant rate") {
  for (const Vec3& v : awkward_vectors()) {
    CAPTURE(v.transpose());
    const Quat right = rotation(v);
    const Vec3 shorter = rotation_vector(right);
    const auto out = slerp({0, 1}, {1, 0, 0, 0, right.w(), right.x(), right.y(), right.z()},
                           {0, 0.125, 0.5, 0.75, 1});
    std::size_t i = 0;
    for (const double part : {0.0, 0.125, 0.5, 0.75, 1.0}) {
      CHECK(std::abs(quat(out, i).norm() - 1.0) <= 2e-15);
      CHECK(angle_between(quat(out, i++), rotation(part * shorter)) <= 5e-15);
    }
  }
}

TEST_CASE("slerp agrees with SciPy") {
  for (const auto seed : fresh_seeds(2)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const double most : {1e-7, 0.1, 1.0, 3.1}) {
      CAPTURE(most);
      const std::size_t n = 2 + random() % 400;
      const auto t = irregular_stamps(n, random);
      const auto knots = rotation_walk(n, most, random);
      const auto at = places_within(t, 700, random);
      const auto theirs = run_python("slerp.py", {{"times", t}, {"knots", knots}, {"at", at}});
      CHECK(worst_angle(slerp(t, knots, at), theirs.at("slerp")) <= 1e-12);
    }
  }
}
