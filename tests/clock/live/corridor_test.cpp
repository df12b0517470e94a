// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/corridor.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

constexpr double rho = 5e-8, beta = 100e-6;

struct Bounds {
  std::vector<std::pair<double, double>> above, below;  // s, x
};

Bounds random_bounds(std::mt19937_64& random) {
  std::exponential_distribution<double> delay(200.0);
  std::uniform_real_distribution<double> when(0.0, 20.0), rate(-beta, beta);
  const double slope = rate(random);
  Bounds bounds;
  for (std::size_t i = 0, n = 1 + random() % 15; i < n; ++i) {
    const double s = when(random);
    bounds.above.emplace_back(s, slope * s + delay(random));
  }
  for (std::size_t i = 0, n = 1 + random() % 15; i < n; ++i) {
    const double s = when(random);
    bounds.below.emplace_back(s, slope * s - delay(random));
  }
  return bounds;
}

/// An independent way: solves a linear programme of two variables by trying each of its corners.
struct Programme {
  std::vector<double> tau_above, above, tau_below, below;

  Programme(const Bounds& bounds, double t) {
    for (const auto& [s, x] : bounds.above) {
      tau_above.push_back(s - t);
      above.push_back(x + rho * (s - t) * (s - t) / 2.0);
    }
    for (const auto& [s, x] : bounds.below) {
      tau_below.push_back(s - t);
      below.push_back(x - rho * (s - t) * (s - t) / 2.0);
    }
  }
  double high(double b) const {
    double least = 1e9;
    for (std::size_t i = 0; i < above.size(); ++i)
      least = std::min(least, above[i] - b * tau_above[i]);
    return least;
  }
  double low(double b) const {
    double most = -1e9;
    for (std::size_t i = 0; i < below.size(); ++i)
      most = std::max(most, below[i] - b * tau_below[i]);
    return most;
  }
  std::vector<double> corners() const {
    std::vector<double> tau = tau_above, x = above, slopes{-beta, beta};
    tau.insert(tau.end(), tau_below.begin(), tau_below.end());
    x.insert(x.end(), below.begin(), below.end());
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double b = (x[i] - x[j]) / (tau[i] - tau[j]);
        if (tau[i] != tau[j] && std::abs(b) <= beta) slopes.push_back(b);
      }
    }
    return slopes;
  }
};

Corridor corridor_of(const Bounds& bounds) {
  Corridor corridor(rho);
  for (const auto& [s, x] : bounds.above) corridor.above.add(s, x);
  for (const auto& [s, x] : bounds.below) corridor.below.add(s, -x);
  return corridor;
}

}  // namespace

TEST_CASE("widest line and range are those of the linear programme") {
  for (const auto seed : fresh_seeds(500)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Bounds bounds = random_bounds(random);
    const Corridor corridor = corridor_of(bounds);
    const double t = std::uniform_real_distribution<double>(-5.0, 25.0)(random);
    const Programme programme(bounds, t);
    double widest = -1e9, high = -1e9, low = 1e9;
    for (const double b : programme.corners()) {
      const double gap = programme.high(b) - programme.low(b);
      widest = std::max(widest, gap);
      if (gap < -1e-15) continue;
      high = std::max(high, programme.high(b));
      low = std::min(low, programme.low(b));
    }
    const CorridorLine line = widest_line(corridor, t, beta);
    CHECK(line.width() == doctest::Approx(widest).epsilon(1e-9));
    const auto range = value_range(corridor, t, beta, line);
    REQUIRE(range.has_value() == (widest >= 0.0));
    if (!range) continue;
    CHECK(std::abs(range->high - high) < 1e-12);
    CHECK(std::abs(range->low - low) < 1e-12);
  }
}

TEST_CASE("bounds that contradict each other leave no range") {
  Corridor corridor(0.0);
  corridor.above.add(0.0, 1.0);
  corridor.below.add(1.0, -1.5);  // 1.5 or more, a second later: 0.5 a second is too steep
  const CorridorLine line = widest_line(corridor, 0.5, beta);
  CHECK(line.width() < 0.0);
  CHECK(!value_range(corridor, 0.5, beta, line));
}

TEST_CASE("after the last bound of a kind its end opens by the greatest rate") {
  Corridor corridor(0.0);
  corridor.above.add(0.0, 1e-3);
  corridor.below.add(0.0, 0.0);
  const auto range = value_range(corridor, 10.0, beta, widest_line(corridor, 10.0, beta));
  REQUIRE(range);
  CHECK(range->high == about(1e-3 + 10.0 * beta));
  CHECK(range->low == about(-10.0 * beta));
}
