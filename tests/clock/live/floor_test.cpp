// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/floor.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

constexpr double us = 1e-6;
constexpr FloorLine level{};  // at 0

/// An independent way: counts the delays that are at least that far above the floor.
std::uint64_t above(const std::vector<double>& all, double excess) {
  return static_cast<std::uint64_t>(
      std::count_if(all.begin(), all.end(), [excess](double e) { return e >= excess; }));
}

}  // namespace

TEST_CASE("a bound's excess is how far it lies above a line") {
  const FloorLine line{10.0, 3e-3, 2e-5};
  CHECK(line.at(10.0) == 3e-3);
  CHECK(line.at(110.0) == about(5e-3));
  CHECK(line.excess({110.0, 6e-3}) == about(1e-3));
  CHECK(line.excess({-90.0, 0.0}) == about(-1e-3));
}

TEST_CASE("the density of evenly spaced delays above a floor is one by their distance") {
  for (std::size_t count : {2U, 3U, 6U, 7U, 8U, 100U}) {
    CAPTURE(count);
    std::vector<double> excess;
    for (std::size_t i = 0; i < count; ++i) excess.push_back(20 * us * static_cast<double>(i));
    std::shuffle(excess.begin(), excess.end(), std::mt19937_64(count));
    CHECK(density_above(excess) == about(1.0 / (20 * us)));
  }
}

TEST_CASE("a density is estimated from the seven nearest, and not from fewer than two") {
  std::vector<double> none, one{20 * us};
  CHECK(density_above(none) == 0.0);
  CHECK(density_above(one) == 0.0);
  std::vector<double> ten{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 60 * us, 1.0, 1.0, 1.0};
  CHECK(density_above(ten) == about(6.0 / (60 * us)));
  // The seven nearest are closer than a counter can resolve, so the seventh counts as a quarter of
  // a microsecond above.
  std::vector<double> all_there(12, 0.0);
  CHECK(density_above(all_there) == about(6.0 / (0.25 * us)));
}

TEST_CASE("the density of random delays is right on average") {
  // The seventh point of a Poisson process of density r follows Gamma(7, r). For that 6 / x has the
  // mean r and the deviation r / sqrt(5): 0.0032 r over 20,000.
  const auto seed = fresh_seeds(1).front();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> step(4000.0);
  double sum = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<double> excess;
    for (double e = step(random); excess.size() < 12; e += step(random)) excess.push_back(e);
    sum += density_above(excess);
  }
  CHECK(sum / 20'000 == about(4000.0, 0.02));
}

TEST_CASE("law: counts say of delays above a level, and of their median, within a factor of two") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> decades(-7.0, 0.5);
    ExcessCounts counts;
    std::vector<double> all;
    const std::size_t most = 1 + random() % 200;
    for (std::size_t i = 0; i < most; ++i) {
      all.push_back(std::pow(10.0, decades(random)));
      counts.add(all.back());
    }
    CHECK(counts.total() == all.size());
    for (int i = 0; i < 20; ++i) {
      const double excess = std::pow(10.0, decades(random));
      CHECK(counts.above(excess) >= above(all, excess));
      CHECK(counts.above(excess) <= above(all, excess < us ? 0.0 : excess / 2.0));
    }
    CHECK(counts.above(-1e-3) == all.size());
    const double median = counts.median();
    CHECK(2 * (all.size() - above(all, median)) >= all.size());
    if (median > us) CHECK(2 * (all.size() - above(all, median / 2.0)) < all.size());
  }
}

TEST_CASE("half of the delays lie below the median, rounded up to a whole class") {
  ExcessCounts counts;
  for (const double excess : {0.5 * us, 3 * us, 3 * us, 70 * us}) counts.add(excess);
  CHECK(counts.median() == 4 * us);  // upper end of the class from 2 to 4 us
  counts.add(70 * us);
  counts.add(70 * us);
  CHECK(counts.median() == 4 * us);
  counts.add(70 * us);
  CHECK(counts.median() == 128 * us);
}

TEST_CASE("law: a floor is as dense as its lowest points of the last hundred seconds are") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> delay(1000.0);
    const FloorLine line{0.0, 1e-3, 1e-5};
    Floor floor(255);
    std::vector<double> all;
    for (double s = 0.0; s < 100.0; s += 0.5) {
      all.push_back(delay(random));
      floor.add({s, line.at(s) + all.back()}, line);
      std::vector<double> told = all;
      CHECK(floor.density(line) == about(density_above(told), 1e-6));
    }
  }
}

TEST_CASE("what lay low a hundred seconds ago is forgotten, and what lies lower is not") {
  for (const double later : {99.0, 101.0}) {
    CAPTURE(later);
    Floor floor(255);
    for (int i = 0; i < 12; ++i) floor.add({0.0, 0.0}, level);
    for (int i = 0; i < 12; ++i) floor.add({later, 1e-3 * i}, level);
    CHECK(floor.density(level) == about(later < 100.0 ? 6.0 / (0.25 * us) : 1000.0));
    CHECK(floor.counts().total() == 24);
  }
}

TEST_CASE("a floor's points bound it as far off as a clock usually bends, 0.01 ppm a second") {
  Floor floor(255);
  floor.add({50.0, 2e-3}, level);
  for (const double t : {-50.0, 50.0, 150.0, 1050.0}) {
    for (const double slope : {0.0, 3e-5}) {
      const double tau = 50.0 - t;
      CHECK(floor.hull().at(t, slope).bound ==
            about(2e-3 + 1e-8 * tau * tau / 2.0 - slope * tau, 1e-12));
    }
  }
}
