// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/spline.h"

#include "tests/motion/interpolation/curves.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

namespace {

Values spline(const Values& times, const Values& values, const Values& at) {
  const std::size_t channels = values.size() / times.size();
  Values bends(values.size(), -7.0), out(at.size() * channels, -7.0);
  const Knots knots{times, values, channels};
  natural_spline(knots, bends);
  spline_at(knots, bends, at, out);
  return out;
}

}  // namespace

TEST_CASE("a natural spline through 0, 1, -1, 2 at 0, 1, 3, 4 is -0.375 at 2") {
  CHECK(spline({0, 1, 3, 4}, {0, 1, -1, 2}, {2.0})[0] == doctest::Approx(-0.375).epsilon(1e-15));
}

TEST_CASE("one knot stays, two knots are joined by a straight line") {
  CHECK(spline({5}, {1, 2}, {5, 5}) == Values{1, 2, 1, 2});
  CHECK(spline({0, 2}, {0, 10, 4, 20}, {0, 0.5, 2}) == Values{0, 10, 1, 12.5, 4, 20});
  CHECK(spline({0, 2}, {0, 10, 4, 20}, {}).empty());
}

TEST_CASE("a natural spline goes through every knot and keeps every straight line") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(2 + random() % 100, random);
    const auto y = random_values(3 * t.size(), random);
    CHECK(worst_difference(spline(t, y, t), y) <= 1e-13);
    Values line(t.size());
    for (std::size_t i = 0; i < t.size(); ++i) line[i] = 3.0 - 2.0 * t[i];
    const auto at = places_within(t, 50, random);
    const auto on_line = spline(t, line, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      CHECK(std::abs(on_line[i] - (3.0 - 2.0 * at[i])) <= 1e-13 * (1.0 + t.back()));
    }
  }
}

TEST_CASE("channels of a spline do not touch each other") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(20, random);
    const std::size_t channels = 1 + random() % 20;
    const auto y = random_values(channels * t.size(), random);
    const auto at = places_within(t, 30, random);
    const auto all = spline(t, y, at);
    for (std::size_t c = 0; c < channels; ++c) {
      Values one, found;
      for (std::size_t i = 0; i < t.size(); ++i) one.push_back(y[i * channels + c]);
      for (std::size_t i = 0; i < at.size(); ++i) found.push_back(all[i * channels + c]);
      CHECK(found == spline(t, one, at));
    }
  }
}

TEST_CASE("a natural spline agrees with SciPy") {
  for (const auto seed : fresh_seeds(4)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t n = 3 + random() % 800;
    for (const auto& t : {jittery_stamps(n, random), irregular_stamps(n, random)}) {
      const auto y = random_values(5 * n, random);
      const auto at = places_within(t, 2 * n, random);
      const auto theirs = run_python("cubic.py", {{"times", t}, {"values", y}, {"at", at}});
      // 1e-12 of the channels' largest value, which is between 1 and 5 here.
      CHECK(worst_difference(spline(t, y, at), theirs.at("spline")) <= 1e-12);
    }
  }
}

TEST_CASE("knots beyond the reach do not move a spline") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(400, random);
    const auto y = random_values(3 * t.size(), random);
    const Values at(t.begin() + 130, t.begin() + 270);
    Values between;
    for (std::size_t i = 0; i + 1 < at.size(); ++i) between.push_back((at[i] + at[i + 1]) / 2);
    const auto from = static_cast<std::ptrdiff_t>(130 - spline_reach);
    const auto to = static_cast<std::ptrdiff_t>(270 + spline_reach);
    const auto part = spline({t.begin() + from, t.begin() + to},
                             {y.begin() + 3 * from, y.begin() + 3 * to}, between);
    CHECK(worst_difference(part, spline(t, y, between)) <= 1e-14);
  }
}
