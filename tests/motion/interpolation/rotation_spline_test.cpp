// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/rotation_spline.h"

#include "tests/motion/interpolation/curves.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

namespace {

/// Angular rate in the body's axes from a central difference.
Vec3 rate_at(const std::vector<double>& t, const std::vector<double>& knots, double at) {
  constexpr double h = 1e-5;
  const auto q = rotation_spline(t, knots, {at - h, at + h});
  return rotation_vector(quat(q, 0).conjugate() * quat(q, 1)) / (2.0 * h);
}

void check_against_scipy(const std::vector<double>& t, const std::vector<double>& knots,
                         std::mt19937_64& random) {
  const auto at = places_within(t, 2 * t.size(), random);
  const auto theirs = run_python("slerp.py", {{"times", t}, {"knots", knots}, {"at", at}});
  CHECK(worst_angle(rotation_spline(t, knots, at), theirs.at("spline")) <= 1e-7);
}

/// Checks the rotations at places in the middle third, from only the knots within the reach of
/// them.
void check_window(const std::vector<double>& t, const std::vector<double>& knots) {
  const std::size_t begin = t.size() / 3, end = 2 * t.size() / 3;
  std::vector<double> at;
  for (std::size_t k = begin; k < end; ++k) at.push_back(0.4 * t[k] + 0.6 * t[k + 1]);
  const auto whole = rotation_spline(t, knots, at);
  const auto from = static_cast<std::ptrdiff_t>(begin - rotation_spline_reach);
  const auto to = static_cast<std::ptrdiff_t>(end + rotation_spline_reach + 1);
  const auto part = rotation_spline({t.begin() + from, t.begin() + to},
                                    {knots.begin() + 4 * from, knots.begin() + 4 * to}, at);
  CHECK(worst_angle(whole, part) <= 1e-12);
}

}  // namespace

TEST_CASE("one knot stays, two knots turn at a constant rate") {
  CHECK(rotation_spline({5}, {0, 1, 0, 0}, {5, 5}) == std::vector<double>{0, 1, 0, 0, 0, 1, 0, 0});
  const Quat end = rotation({0.2, -0.4, 0.6});
  const auto q =
      rotation_spline({1, 3}, {1, 0, 0, 0, end.w(), end.x(), end.y(), end.z()}, {1, 1.5, 3});
  CHECK(angle_between(quat(q, 0), Quat::Identity()) <= 1e-15);
  CHECK(angle_between(quat(q, 1), rotation({0.05, -0.1, 0.15})) <= 1e-15);
  CHECK(angle_between(quat(q, 2), end) <= 1e-15);
}

TEST_CASE("a turn at a constant rate stays one, on any stamps") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(2 + random() % 50, random);
    const Vec3 rate = 10.0 * random_direction(random);
    std::vector<double> knots(4 * t.size());
    for (std::size_t i = 0; i < t.size(); ++i) put_quat(knots, i, rotation(t[i] * rate));
    const auto at = places_within(t, 50, random);
    const auto q = rotation_spline(t, knots, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      CHECK(angle_between(quat(q, i), rotation(at[i] * rate)) <= 1e-12);
    }
  }
}

TEST_CASE("a rotation spline goes through every knot") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(1 + random() % 60, random);
    const auto knots = rotation_walk(t.size(), 3.0, random);
    // The cubics have up to a thousand radians, and cancel at the knots, which are 3 rad apart.
    CHECK(worst_angle(rotation_spline(t, knots, t), knots) <= 1e-12);
  }
}

TEST_CASE("angular rate and acceleration do not jump at the knots") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = jittery_stamps(12, random);
    const auto knots = rotation_walk(t.size(), 0.5, random);
    for (std::size_t k = 1; k + 1 < t.size(); ++k) {
      // Differences over 1e-5 s are accurate to 1e-9 rad/s. The acceleration is up to 5e3 rad/s2
      // and changes by 1e6 rad/s3, which is 50 rad/s2 in the 2.5e-5 s between the compared places.
      const Vec3 before = rate_at(t, knots, t[k] - 2e-5), after = rate_at(t, knots, t[k] + 2e-5);
      const Vec3 bend_before = (before - rate_at(t, knots, t[k] - 4e-5)) / 2e-5;
      const Vec3 bend_after = (rate_at(t, knots, t[k] + 4e-5) - after) / 2e-5;
      CHECK((after - before).norm() <= 0.5);
      CHECK((bend_after - bend_before).norm() <= 100.0);
    }
  }
}

TEST_CASE("a rotation spline agrees with SciPy on smooth, random, fast and irregular knots") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t n = 2 + random() % 600;
    const auto jittery = jittery_stamps(n, random), irregular = irregular_stamps(n, random);
    check_against_scipy(jittery, smooth_rotations(jittery), random);
    check_against_scipy(irregular, smooth_rotations(irregular), random);
    for (const double most : {1e-6, 0.1, 0.5, 1.0, 2.0, 2.5}) {
      CAPTURE(most);
      check_against_scipy(jittery, rotation_walk(n, most, random), random);
      check_against_scipy(irregular, rotation_walk(n, most, random), random);
    }
  }
}

TEST_CASE("a rotation spline of thousands of knots, solved in windows, agrees with SciPy") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = jittery_stamps(3333, random);
    check_against_scipy(t, rotation_walk(t.size(), 0.5, random), random);
  }
}

TEST_CASE("a rotation spline of three knots agrees with SciPy") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    check_against_scipy(irregular_stamps(3, random), rotation_walk(3, 1.0, random), random);
  }
}

TEST_CASE("knots beyond the reach do not move a rotation spline") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t n = 400;
    const auto jittery = jittery_stamps(n, random), irregular = irregular_stamps(n, random);
    check_window(jittery, smooth_rotations(jittery));
    check_window(irregular, smooth_rotations(irregular));
    for (const double most : {0.1, 1.0, 2.5}) {
      CAPTURE(most);
      check_window(jittery, rotation_walk(n, most, random));
      check_window(irregular, rotation_walk(n, most, random));
    }
  }
}
