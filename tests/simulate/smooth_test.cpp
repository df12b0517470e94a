// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/smooth.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <functional>
#include <random>

using namespace kinalign;

namespace {

/// The largest n-th difference over h^n. It stays the same as h shrinks if the n-th derivative is
/// bounded, and grows as 1 / h if the derivative before it jumps.
double roughest(const std::function<double(double)>& f, int order, double h) {
  double worst = 0.0;
  for (double t = -0.5; t < 1.5; t += 0.3 * h) {
    double sum = 0.0, binomial = 1.0;
    for (int k = 0; k <= order; ++k) {
      sum += (k % 2 == 0 ? 1.0 : -1.0) * binomial * f(t + k * h);
      binomial = binomial * (order - k) / (k + 1);
    }
    worst = std::max(worst, std::abs(sum) / std::pow(h, order));
  }
  return worst;
}

}  // namespace

TEST_CASE("rise and glide go from 0 to 1, never back, and the same way from both ends") {
  for (double (*curve)(double) : {&rise, &glide}) {
    CHECK(curve(-1.0) == 0.0);
    CHECK(curve(0.0) == 0.0);
    CHECK(curve(0.5) == about(0.5));
    CHECK(curve(1.0) == 1.0);
    CHECK(curve(2.0) == 1.0);
    for (double x = 0.0; x < 1.0; x += 0.001) {
      CHECK(curve(x + 0.001) >= curve(x));
      CHECK(curve(x) + curve(1.0 - x) == about(1.0));
    }
  }
  CHECK((glide(0.5001) - glide(0.4999)) / 0.0002 == about(1.0 / 0.58));
  CHECK((rise(0.5001) - rise(0.4999)) / 0.0002 == about(35.0 / 16.0, 1e-6));
}

TEST_CASE("a bump is 1 in the middle and 0 outside") {
  CHECK(bump(-0.1) == 0.0);
  CHECK(bump(0.5) == 1.0);
  CHECK(bump(0.25) == about(std::pow(0.75, 4)));
  CHECK(bump(1.2) == 0.0);
}

TEST_CASE("no derivative up to the third jumps") {
  // A jump would make the fourth difference four times as large at a quarter of the step.
  const ControlTrack track(0.2, {0.0, 1.0, -1.0, 2.0, 2.0, 0.0});
  const auto track_at = [&](double t) { return track.at(t); };
  for (const auto& curve :
       std::initializer_list<std::function<double(double)>>{&rise, &glide, &bump, track_at}) {
    CHECK(roughest(curve, 4, 0.005) < 1.5 * roughest(curve, 4, 0.02));
  }
}

TEST_CASE("a soft minimum is below both, by half the width where they meet, and near the smaller") {
  CHECK(soft_min(3.0, 3.0, 0.1) == about(2.95));
  CHECK(soft_min(3.0, 5.0, 0.1) == about(3.0, 0.001));
  CHECK(soft_min(5.0, 3.0, 0.1) == soft_min(3.0, 5.0, 0.1));
  CHECK(soft_min(3.0, 3.01, 0.1) < 3.0);
}

TEST_CASE("a track keeps constants and straight lines, never leaves its controls, and ends stand") {
  std::vector<double> line(20), level(20, 7.0);
  for (std::size_t k = 0; k < line.size(); ++k) line[k] = 0.5 * static_cast<double>(k);
  const ControlTrack straight(0.2, line), constant(0.2, level);
  for (double t = 0.6; t < 3.2; t += 0.01) {  // two and a half controls from both ends
    CHECK(straight.at(t) == about(2.5 * t, 1e-12));
    CHECK(constant.at(t) == about(7.0, 1e-14));
  }
  CHECK(straight.at(-1e12) == about(0.0));
  CHECK(straight.at(1e12) == about(9.5));
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<double> controls(10);
    for (double& x : controls) x = static_cast<double>(random() % 100);
    const auto [least, most] = std::minmax_element(controls.begin(), controls.end());
    const ControlTrack track(0.2, controls);
    for (double t = -1.0; t < 3.0; t += 0.013) {
      CHECK(track.at(t) >= *least - 1e-12);
      CHECK(track.at(t) <= *most + 1e-12);
    }
  }
}
