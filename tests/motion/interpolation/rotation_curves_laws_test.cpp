// SPDX-License-Identifier: Apache-2.0
// Rules for both curves through rotations, slerp and spline, on any stamps.
#include "tests/motion/interpolation/curves.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"

#include <Eigen/Dense>
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace kinalign;

namespace {

using Curve = Values (*)(const Values& times, const Values& knots, const Values& at);

constexpr std::array<Curve, 2> curves{slerp, rotation_spline};

/// Rotations up to a radian apart, some of them equal to the one before.
struct Case {
  Values times, knots, at;

  explicit Case(std::mt19937_64& random)
      : times(irregular_stamps(1 + random() % 60, random)),
        knots(rotation_walk(times.size(), random() % 5 == 0 ? 0.0 : 1.0, random)),
        at(places_within(times, 100, random)) {}
};

template <class Change>
Values turned(const Values& rotations, Change&& change) {
  Values out(rotations.size());
  for (std::size_t i = 0; i < rotations.size() / 4; ++i) {
    put_quat(out, i, change(quat(rotations, i)));
  }
  return out;
}

/// The knots' slopes of the cubic spline through angles, whose end slopes are those of the first
/// and the last interval; from a dense system of equations.
Eigen::VectorXd end_slopes_spline(const Values& t, const Values& angle) {
  const auto n = static_cast<Eigen::Index>(t.size());
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right(n);
  const auto h = [&t](std::size_t k) { return t[k + 1] - t[k]; };
  const auto r = [&](std::size_t k) { return (angle[k + 1] - angle[k]) / h(k); };
  for (std::size_t k = 1; k + 1 < t.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    m(i, i - 1) = 1.0 / h(k - 1);
    m(i, i) = 2.0 / h(k - 1) + 2.0 / h(k);
    m(i, i + 1) = 1.0 / h(k);
    right(i) = 3.0 * (r(k - 1) / h(k - 1) + r(k) / h(k));
  }
  m(0, 0) = m(n - 1, n - 1) = 1.0;
  right(0) = r(0);
  right(n - 1) = r(t.size() - 2);
  return m.partialPivLu().solve(right);
}

/// Hermite's cubic in an interval, at the fraction s of it.
double cubic(double a, double b, double slope_a, double slope_b, double s) {
  return a + s * (slope_a + s * (3.0 * (b - a) - 2.0 * slope_a - slope_b +
                                 s * (slope_a + slope_b - 2.0 * (b - a))));
}

}  // namespace

TEST_CASE("a curve of rotations goes with the world it is seen in, and with the body's own axes") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    const Quat turn = random_rotation(random);
    const auto left = [&turn](const Quat& q) { return turn * q; };
    const auto right = [&turn](const Quat& q) { return q * turn; };
    for (const Curve curve : curves) {
      const Values found = curve(c.times, c.knots, c.at);
      CHECK(worst_angle(curve(c.times, turned(c.knots, left), c.at), turned(found, left)) <= 1e-11);
      CHECK(worst_angle(curve(c.times, turned(c.knots, right), c.at), turned(found, right)) <=
            1e-11);
    }
  }
}

TEST_CASE("which of its two quaternions a knot is given by is no matter") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    const Values others = turned(
        c.knots, [&random](const Quat& q) { return random() % 2 == 0 ? q : Quat(-q.coeffs()); });
    for (const Curve curve : curves) {
      CHECK(worst_angle(curve(c.times, c.knots, c.at), curve(c.times, others, c.at)) <= 1e-14);
    }
  }
}

TEST_CASE("every rotation of a curve is of length 1") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    for (const Curve curve : curves) {
      const Values found = curve(c.times, c.knots, c.at);
      for (std::size_t i = 0; i < c.at.size(); ++i) {
        // In a long interval after a short one, the terms of the cubic are tens of radians long
        // and cancel; their rounding changes the length. The worst of two million cases was 6e-15.
        CHECK(std::abs(quat(found, i).norm() - 1.0) <= 2e-14);
      }
    }
  }
}

TEST_CASE("a curve of rotations is the same one whenever it begins and however fast its clock is") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    for (const Curve curve : curves) {
      const Values found = curve(c.times, c.knots, c.at);
      for (const double scale : {0.25, 3.0, 64.0}) {
        const auto faster = [scale](double t) { return scale * t; };
        CHECK(worst_angle(curve(each(c.times, faster), c.knots, each(c.at, faster)), found) <=
              1e-11);
      }
      const auto later = [](double t) { return t + 100.0; };
      CHECK(worst_angle(curve(each(c.times, later), c.knots, each(c.at, later)), found) <= 1e-9);
    }
  }
}

TEST_CASE("the value of a curve at a place does not depend on other requested places") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    const std::size_t i = random() % c.at.size();
    for (const Curve curve : curves) {
      const Values all = curve(c.times, c.knots, c.at);
      const Values one = curve(c.times, c.knots, {c.at[i]});
      CHECK(worst_angle(one, std::span(all).subspan(4 * i, 4)) <= 1e-15);
    }
  }
}

TEST_CASE("a motion played backwards has the slerp played backwards") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    const double end = c.times.back();
    const auto reversed = [end](const Values& times) {
      Values out = each(times, [end](double t) { return end - t; });
      std::reverse(out.begin(), out.end());
      return out;
    };
    const auto reversed_rotations = [](const Values& rotations) {
      Values out(rotations.size());
      const std::size_t n = rotations.size() / 4;
      for (std::size_t i = 0; i < n; ++i) put_quat(out, i, quat(rotations, n - 1 - i));
      return out;
    };
    const Values found = slerp(reversed(c.times), reversed_rotations(c.knots), reversed(c.at));
    CHECK(worst_angle(reversed_rotations(found), slerp(c.times, c.knots, c.at)) <= 1e-12);
  }
}

TEST_CASE("a knot put in where the slerp runs anyway changes nothing") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Case c(random);
    const Values found = slerp(c.times, c.knots, c.at);
    // Now all places are knots.
    CHECK(worst_angle(slerp(c.at, found, c.at), found) <= 1e-15);
    Values times = c.times, knots = c.knots;
    if (times.size() < 2) continue;
    const double place = 0.3 * times[0] + 0.7 * times[1];
    const Values there = slerp(times, knots, {place});
    times.insert(times.begin() + 1, place);
    knots.insert(knots.begin() + 4, there.begin(), there.end());
    CHECK(worst_angle(slerp(times, knots, c.at), found) <= 1e-13);
  }
}

TEST_CASE("a slerp depends only on the two knots around a place") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(10, random);
    const Values knots = rotation_walk(10, 2.0, random);
    const std::size_t k = random() % 9;
    const double place = 0.4 * t[k] + 0.6 * t[k + 1];
    const auto from = static_cast<std::ptrdiff_t>(k);
    const Values pair(knots.begin() + 4 * from, knots.begin() + 4 * from + 8);
    CHECK(slerp(t, knots, {place}) == slerp({t[k], t[k + 1]}, pair, {place}));
  }
}

TEST_CASE("about one axis a rotation spline is the cubic spline of the angles") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> step(-1.5, 1.5);
    const auto t = irregular_stamps(2 + random() % 60, random);
    const Vec3 axis = random_direction(random);
    Values angle(t.size(), step(random)), knots(4 * t.size());
    for (std::size_t i = 1; i < t.size(); ++i) angle[i] = angle[i - 1] + step(random);
    for (std::size_t i = 0; i < t.size(); ++i) put_quat(knots, i, rotation(angle[i] * axis));
    const Eigen::VectorXd slopes = end_slopes_spline(t, angle);
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
      const double h = t[k + 1] - t[k], s = 0.001 * static_cast<double>(random() % 1000);
      const auto i = static_cast<Eigen::Index>(k);
      const double expected = cubic(angle[k], angle[k + 1], h * slopes(i), h * slopes(i + 1), s);
      const Values found = rotation_spline(t, knots, {t[k] + s * h});
      CHECK(angle_between(quat(found, 0), rotation(expected * axis)) <= 1e-10);
    }
  }
}
