// SPDX-License-Identifier: Apache-2.0
// Rules for the fit, whatever the points are.
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rigid_fit.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace kinalign;

namespace {

using Points = std::vector<Vec3>;

/// A cloud a metre wide, `far` metres from the origin.
Points cloud(std::size_t n, double far, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vec3 middle = far * random_direction(random);
  Points points(n);
  for (Vec3& p : points) p = middle + Vec3(normal(random), normal(random), normal(random));
  return points;
}

RigidTransform any_transform(double far, std::mt19937_64& random) {
  return {random_rotation(random), far * random_direction(random)};
}

Points moved_by(const RigidTransform& transform, Points points) {
  for (Vec3& p : points) p = transform * p;
  return points;
}

/// The same cloud, each point moved randomly by 5 cm.
Points shaken(Points points, std::mt19937_64& random) {
  for (Vec3& p : points) p += 0.05 * random_direction(random);
  return points;
}

PairMoments moments_of(const Points& from, const Points& to) {
  PairMoments moments;
  for (std::size_t i = 0; i < from.size(); ++i) moments.add(from[i], to[i]);
  return moments;
}

RigidTransform fitted(const Points& from, const Points& to) {
  const auto fit = fit_rigid(moments_of(from, to));
  REQUIRE(fit);
  return *fit;
}

/// The largest distance between the same points after either transform, m.
double apart(const RigidTransform& a, const RigidTransform& b, const Points& points) {
  double worst = 0.0;
  for (const Vec3& p : points) worst = std::max(worst, (a * p - b * p).norm());
  return worst;
}

RigidTransform after(const RigidTransform& second, const RigidTransform& first) {
  return {second.rotation * first.rotation, second * first.translation};
}

bool is_refused(const Points& from, const Points& to) {
  const auto fit = fit_rigid(moments_of(from, to));
  return !fit && fit.error().found == "a line";
}

}  // namespace

TEST_CASE("any turn and shift is found again from three points on, near and a kilometre away") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (const double far : {0.0, 3.0, 1000.0}) {
      CAPTURE(far);
      const RigidTransform truth = any_transform(far, random);
      const Points from = cloud(8 + random() % 50, far, random);
      const RigidTransform found = fitted(from, moved_by(truth, from));
      CHECK(std::abs(found.rotation.norm() - 1.0) <= 2e-15);
      CHECK(apart(found, truth, from) <= 1e-13 * (10.0 + 10.0 * far));
    }
    // The smallest well-shaped set: three points of a right angle.
    const Points corner{{0, 0, 1}, {1, 0, 1}, {0, 2, 1}};
    const RigidTransform truth = any_transform(2.0, random);
    CHECK(apart(fitted(corner, moved_by(truth, corner)), truth, corner) <= 1e-13);
  }
}

TEST_CASE("points in one plane are turned, not mirrored") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const RigidTransform truth = any_transform(2.0, random), plane = any_transform(1.0, random);
    Points flat = cloud(20, 0.0, random);
    for (Vec3& p : flat) p = plane * Vec3(p.x(), p.y(), 0.0);
    const RigidTransform found = fitted(flat, moved_by(truth, flat));
    CHECK(angle_between(found.rotation, truth.rotation) <= 1e-12);
  }
}

TEST_CASE("a fit does not depend on the order of the pairs, nor on taking all of them twice") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Points from = cloud(30, 100.0, random);
    const Points to = shaken(moved_by(any_transform(5.0, random), from), random);
    std::vector<std::size_t> order(from.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random);
    order.insert(order.end(), order.rbegin(), order.rend());
    Points other_from, other_to;
    for (const std::size_t i : order) {
      other_from.push_back(from[i]);
      other_to.push_back(to[i]);
    }
    CHECK(apart(fitted(from, to), fitted(other_from, other_to), from) <= 1e-11);
  }
}

TEST_CASE("a fit goes with the spaces of both sides, and the other way round it is the inverse") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Points from = cloud(25, 2.0, random);
    const Points to = shaken(moved_by(any_transform(3.0, random), from), random);
    const RigidTransform fit = fitted(from, to), other = any_transform(4.0, random);
    CHECK(apart(fitted(from, moved_by(other, to)), after(other, fit), from) <= 1e-12);
    CHECK(apart(after(fitted(moved_by(other, from), to), other), fit, from) <= 1e-12);
    CHECK(apart(after(fitted(to, from), fit), RigidTransform{}, from) <= 1e-12);
  }
}

TEST_CASE("a fit brings the mean onto the mean") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    // Two clouds without any relation.
    const Points from = cloud(10, 5.0, random), to = cloud(10, 50.0, random);
    Vec3 from_mean = Vec3::Zero(), to_mean = Vec3::Zero();
    for (const Vec3& p : from) from_mean += 0.1 * p;
    for (const Vec3& p : to) to_mean += 0.1 * p;
    CHECK((fitted(from, to) * from_mean - to_mean).norm() <= 1e-12);
  }
}

TEST_CASE("points on one line have no fit, wherever it lies and on whichever side") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const Vec3 begin = 3.0 * random_direction(random), along = random_direction(random);
    Points line(20);
    for (Vec3& p : line) p = begin + normal(random) * along;
    const Points wide = cloud(20, 3.0, random);
    CHECK(is_refused(line, moved_by(any_transform(3.0, random), line)));
    CHECK(is_refused(line, wide));
    CHECK(is_refused(wide, line));
    CHECK(is_refused(line, Points(20, begin)));
    CHECK(spread_off_line(moments_of(line, line)) <= 1e-7);
  }
}

TEST_CASE("the spread beside a line is that of the points, wherever they are moved") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    // A cross in a plane: 1 m along its line, `width` beside it, 1 mm across the plane.
    const double width = 0.01 + 0.001 * static_cast<double>(random() % 900);
    Points from{{1, 0, 0}, {-1, 0, 0}, {0, width, 0}, {0, -width, 0}, {0, 0, 1e-3}, {0, 0, -1e-3}};
    from = moved_by(any_transform(20.0, random), from);
    const PairMoments moments = moments_of(from, moved_by(any_transform(20.0, random), from));
    CHECK(spread_off_line(moments) == doctest::Approx(width / std::sqrt(3.0)).epsilon(1e-9));
  }
}
