// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/rigid_fit.h"

#include "tests/motion/rotations.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

namespace {

struct Pairs {
  std::vector<double> from, to;  // [n,3]

  std::size_t size() const { return from.size() / 3; }
};

/// Points about 3 m away, a kilometre more if `far`; turned, moved, and with noise of 0.1 m.
Pairs noisy_pairs(std::size_t n, double far, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const RigidTransform truth{random_rotation(random), Vec3(1, -2, 0.5)};
  Pairs pairs{std::vector<double>(3 * n), std::vector<double>(3 * n)};
  for (std::size_t i = 0; i < n; ++i) {
    vec3(pairs.from, i) = Vec3(normal(random) + far, normal(random), normal(random) + 3.0);
    vec3(pairs.to, i) =
        truth * vec3(pairs.from, i) + 0.1 * normal(random) * random_direction(random);
  }
  return pairs;
}

PairMoments moments_of(const Pairs& pairs) {
  PairMoments moments;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    moments.add(vec3(pairs.from, i), vec3(pairs.to, i));
  return moments;
}

double plain_rms(const Pairs& pairs, const RigidTransform& transform) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    sum += (transform * vec3(pairs.from, i) - vec3(pairs.to, i)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

}  // namespace

TEST_CASE("a rigid fit agrees with SciPy's") {
  for (const auto seed : fresh_seeds(4)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const double far = random() % 2 == 0 ? 0.0 : 1000.0;
    const Pairs pairs = noisy_pairs(3 + random() % 300, far, random);
    const auto fit = fit_rigid(moments_of(pairs));
    REQUIRE(fit);
    const auto theirs = run_python("rigid.py", {{"from", pairs.from}, {"to", pairs.to}});
    CHECK(angle_between(fit->rotation, quat(theirs.at("rotation"), 0)) <= 1e-7);
    CHECK((fit->translation - vec3(theirs.at("translation"), 0)).norm() <= 1e-6);
    CHECK(std::abs(plain_rms(pairs, *fit) - theirs.at("rms")[0]) <= 1e-10);
  }
}

TEST_CASE("no small turn or shift betters a rigid fit") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Pairs pairs = noisy_pairs(20, 0.0, random);
    const auto fit = fit_rigid(moments_of(pairs));
    REQUIRE(fit);
    const double best = plain_rms(pairs, *fit);
    for (int i = 0; i < 20; ++i) {
      RigidTransform other = *fit;
      other.rotation = other.rotation * Eigen::AngleAxisd(1e-3, random_direction(random));
      CHECK(plain_rms(pairs, other) > best);
      other = *fit;
      other.translation += 1e-3 * random_direction(random);
      CHECK(plain_rms(pairs, other) > best);
    }
  }
}

TEST_CASE("a fit is a turn even where a mirror image would fit better") {
  PairMoments moments;
  for (const Vec3& p : {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3), Vec3(1, 1, 1)}) {
    moments.add(p, Vec3(-p.x(), p.y(), p.z()));
  }
  const auto fit = fit_rigid(moments);
  REQUIRE(fit);
  CHECK(fit->rotation.toRotationMatrix().determinant() == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("points on a line, or fewer than three pairs, have no fit") {
  PairMoments line;
  for (int i = 0; i < 10; ++i) line.add(Vec3(i, 2 * i, 5), Vec3(0, i, 3 * i));
  const auto on_line = fit_rigid(line);
  REQUIRE(!on_line);
  CHECK(to_string(on_line.error()) == "expected points that are not on one line, found a line");
  PairMoments two;
  two.add(Vec3(0, 0, 0), Vec3(0, 0, 0));
  two.add(Vec3(1, 0, 0), Vec3(1, 0, 0));
  const auto few = fit_rigid(two);
  REQUIRE(!few);
  CHECK(to_string(few.error()) == "expected three pairs of points for a rigid fit, found 2");
  PairMoments one_place;
  for (int i = 0; i < 5; ++i) one_place.add(Vec3(1, 2, 3), Vec3(4, 5, 6));
  CHECK(!fit_rigid(one_place));
}

TEST_CASE("points beside a line tell how sure the turn about it is") {
  PairMoments moments;
  for (const double y : {-1.0, 1.0}) {
    for (const double x : {-0.05, 0.05}) moments.add({x, y, 3.0}, {x, y, 0.0});
  }
  CHECK(spread_off_line(moments) == doctest::Approx(0.05).epsilon(1e-12));
  CHECK(spread_off_line({}) == 0.0);
}
