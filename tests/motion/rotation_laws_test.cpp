// SPDX-License-Identifier: Apache-2.0
// Rules for rotations and their vectors.
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace kinalign;

TEST_CASE("turns about one axis add up, and a turn back undoes one") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> angle(-6.0, 6.0);
    const Vec3 axis = random_direction(random);
    const double a = angle(random), b = angle(random);
    CHECK(angle_between(rotation(a * axis) * rotation(b * axis), rotation((a + b) * axis)) <=
          1e-14);
    CHECK(rotation(-a * axis).coeffs() == rotation(a * axis).conjugate().coeffs());
  }
}

TEST_CASE("the axis of a turn stays, and what is across it turns by the vector's length") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const double angle = std::uniform_real_distribution<double>(0.0, std::numbers::pi)(random);
    const Vec3 axis = random_direction(random), across = axis.unitOrthogonal();
    const Quat q = rotation(angle * axis);
    CHECK((q * axis - axis).norm() <= 2e-15);
    const Vec3 expected = std::cos(angle) * across + std::sin(angle) * axis.cross(across);
    CHECK((q * across - expected).norm() <= 3e-15);
  }
}

TEST_CASE("a frame that is turned turns the vectors of its rotations") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Vec3 v =
        std::uniform_real_distribution<double>(0.0, 6.0)(random) * random_direction(random);
    const Quat frame = random_rotation(random);
    CHECK(angle_between(frame * rotation(v) * frame.conjugate(), rotation(frame * v)) <= 1e-14);
  }
}

TEST_CASE("the parts of a rotation vector up to half a turn lead back to it") {
  for (const Vec3& v : awkward_vectors()) {
    if (v.norm() > std::numbers::pi) continue;
    CAPTURE(v.transpose());
    const RotationParts parts = rotation_parts(v.squaredNorm());
    const Vec3 across = parts.vector * v;
    CHECK(parts.w * parts.w + across.squaredNorm() == doctest::Approx(1.0).epsilon(2e-15));
    const double factor = rotation_vector_factor(parts.w, across.squaredNorm());
    const double limit = 3e-15 * (1.0 + v.norm());
    // At half a turn, where w is zero or a rounding error, the vector may be the opposite one.
    const double off = std::min((factor * across - v).norm(), (factor * across + v).norm());
    CHECK((v.norm() < std::numbers::pi - 1e-12 ? (factor * across - v).norm() : off) <= limit);
    // The other quaternion of the same rotation.
    CHECK(rotation_vector_factor(-parts.w, across.squaredNorm()) == -factor);
  }
}
