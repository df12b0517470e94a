// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/lifted_hull.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

struct Point {
  double s, bound;
};

std::vector<Point> random_points(std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> step(0.0, 0.2), delay(0.0, 0.06);
  std::vector<Point> points;
  double s = 0.0;
  for (std::size_t i = 0; i < n; ++i) points.push_back({s += step(random), delay(random)});
  return points;
}

/// An independent slow way: looks at every bound.
double least(const std::vector<Point>& points, double rho, double t, double slope) {
  double bound = 1e9;
  for (const Point& p : points) {
    const double tau = p.s - t;
    bound = std::min(bound, p.bound + rho * tau * tau / 2.0 - slope * tau);
  }
  return bound;
}

}  // namespace

TEST_CASE("at any time and slope the hull gives the least of all bounds") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const double rho = std::array{0.0, 1e-8, 5e-8, 2e-6, 1e-3}[random() % 5];
    auto points = random_points(1 + random() % 200, random);
    const double end = points.back().s;
    if (seed % 2 == 0) {  // a few points come late
      for (std::size_t i = 3; i < points.size(); i += 7)
        std::swap(points[i], points[i - 1 - random() % 3]);
    }
    LiftedHull hull(rho);
    for (const Point& p : points) hull.add(p.s, p.bound);
    std::uniform_real_distribution<double> when(-5.0, end + 5.0), slope(-0.01, 0.01);
    for (int i = 0; i < 50; ++i) {
      const double t = when(random), b = slope(random);
      CHECK(hull.at(t, b).bound == doctest::Approx(least(points, rho, t, b)).epsilon(1e-12));
    }
    const double t = when(random);
    std::array<double, 24> bounds{};
    hull.bounds_at(t, -0.01, 0.02 / 23, bounds);
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const double b = -0.01 + 0.02 / 23 * static_cast<double>(i);
      CHECK(bounds[i] == doctest::Approx(hull.at(t, b).bound).epsilon(1e-12));
    }
  }
}

TEST_CASE("the peak is the greatest bound that any slope leaves") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto points = random_points(3 + random() % 50, random);
    LiftedHull hull(5e-8);
    for (const Point& p : points) hull.add(p.s, p.bound);
    std::uniform_real_distribution<double> when(points.front().s, points.back().s);
    CHECK(hull.peak(points.front().s).bound == points.front().bound);
    CHECK(hull.peak(points.back().s).bound == doctest::Approx(points.back().bound));
    const double t = when(random);
    const auto peak = hull.peak(t);
    CHECK(peak.bound == doctest::Approx(least(points, 5e-8, t, peak.slope)).epsilon(1e-12));
    for (double b = -0.1; b < 0.1; b += 0.001)
      CHECK(least(points, 5e-8, t, b) <= peak.bound + 1e-12);
  }
}

TEST_CASE("a hull that forgets its oldest corners never bounds more") {
  std::mt19937_64 random(1);
  const auto points = random_points(500, random);
  LiftedHull all(5e-8), few(5e-8, 6);
  for (const Point& p : points) {
    all.add(p.s, p.bound);
    few.add(p.s, p.bound);
    CHECK(few.size() <= 6);
    CHECK(few.at(p.s, 1e-5).bound >= all.at(p.s, 1e-5).bound);
  }
}

TEST_CASE("two bounds at one time are the lower one") {
  LiftedHull hull(0.0);
  hull.add(1.0, 5.0);
  hull.add(1.0, 3.0);
  hull.add(1.0, 4.0);
  CHECK(hull.size() == 1);
  CHECK(hull.at(1.0, 0.0).bound == 3.0);
}
