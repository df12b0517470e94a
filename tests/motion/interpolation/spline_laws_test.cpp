// SPDX-License-Identifier: Apache-2.0
// Rules for natural cubic splines through any values at any stamps.
#include "tests/motion/interpolation/curves.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/interpolation/spline.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace kinalign;

namespace {

struct Spline {
  Values times, values, bends;  // one channel

  Spline(Values t, Values y) : times(std::move(t)), values(std::move(y)), bends(times.size()) {
    natural_spline({times, values, 1}, bends);
  }
  Values operator()(const Values& at) const {
    Values out(at.size(), -7.0);
    spline_at({times, values, 1}, bends, at, out);
    return out;
  }
};

Values backwards(const Values& values) { return {values.rbegin(), values.rend()}; }

}  // namespace

TEST_CASE("slope and bend do not jump at a knot, and nothing bends at the ends") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(3 + random() % 100, random);
    const Spline s(t, random_values(t.size(), random));
    CHECK(s.bends.front() == 0.0);
    CHECK(s.bends.back() == 0.0);
    for (std::size_t i = 1; i + 1 < t.size(); ++i) {
      // The slopes here of the two cubics that meet, from their values and second derivatives.
      const double h = t[i] - t[i - 1], k = t[i + 1] - t[i];
      const double before =
          (s.values[i] - s.values[i - 1]) / h + h * (s.bends[i - 1] + 2.0 * s.bends[i]) / 6.0;
      const double after =
          (s.values[i + 1] - s.values[i]) / k - k * (2.0 * s.bends[i] + s.bends[i + 1]) / 6.0;
      CHECK(std::abs(before - after) <= 1e-12 * (1.0 / h + 1.0 / k) * 10.0);
    }
  }
}

TEST_CASE("between knots a spline is the cubic of its values and bends") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(2 + random() % 50, random);
    const Spline s(t, random_values(t.size(), random));
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      const double h = t[i + 1] - t[i];
      // Half way, a cubic is the mean of its ends minus an eighth of h^2 times their mean second
      // derivative.
      const double middle =
          (s.values[i] + s.values[i + 1]) / 2.0 - h * h * (s.bends[i] + s.bends[i + 1]) / 16.0;
      CHECK(std::abs(s({t[i] + h / 2.0})[0] - middle) <= 1e-12);
    }
  }
}

TEST_CASE("the spline of a sum is the sum of the splines") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(1 + random() % 100, random);
    const auto a = random_values(t.size(), random), b = random_values(t.size(), random);
    const auto at = places_within(t, 100, random);
    Values sum(t.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = 3.0 * a[i] - 0.5 * b[i];
    const auto of_a = Spline(t, a)(at), of_b = Spline(t, b)(at);
    Values expected(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) expected[i] = 3.0 * of_a[i] - 0.5 * of_b[i];
    CHECK(worst_difference(Spline(t, sum)(at), expected) <= 1e-12);
  }
}

TEST_CASE("a knot put in where the spline runs anyway changes nothing") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(2 + random() % 60, random);
    const Spline s(t, random_values(t.size(), random));
    // Not so near to a knot that the slope between them loses its digits.
    const std::size_t i = random() % (t.size() - 1);
    const double part = 0.1 + 0.008 * static_cast<double>(random() % 100);
    const double place = t[i] + part * (t[i + 1] - t[i]);
    Values times = t, values = s.values;
    const auto behind = static_cast<std::ptrdiff_t>(i + 1);
    times.insert(times.begin() + behind, place);
    values.insert(values.begin() + behind, s({place})[0]);
    const auto at = places_within(t, 100, random);
    CHECK(worst_difference(Spline(times, values)(at), s(at)) <= 1e-11);
  }
}

TEST_CASE("a spline is the same one whenever it begins and however fast its clock runs") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(1 + random() % 100, random);
    const auto y = random_values(t.size(), random);
    const auto at = places_within(t, 100, random);
    const auto expected = Spline(t, y)(at);
    for (const double scale : {0.25, 8.0}) {  // exact, so that no bit differs
      const auto faster = [scale](double v) { return scale * v; };
      const Spline s(each(t, faster), y);
      CHECK(s(each(at, faster)) == expected);
      CHECK(s.bends == each(Spline(t, y).bends, [scale](double b) { return b / scale / scale; }));
    }
    const auto later = [](double v) { return v + 100.0; };
    CHECK(worst_difference(Spline(each(t, later), y)(each(at, later)), expected) <= 1e-9);
    const auto thrice = [](double v) { return 3.0 * v; };
    CHECK(worst_difference(Spline(each(t, thrice), y)(each(at, thrice)), expected) <= 1e-11);
  }
}

TEST_CASE("a motion played backwards has the spline played backwards") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(1 + random() % 100, random);
    const auto y = random_values(t.size(), random);
    const auto at = places_within(t, 100, random);
    const double end = t.back();
    const auto from_end = [end](double v) { return end - v; };
    const Spline reversed(backwards(each(t, from_end)), backwards(y));
    const auto found = reversed(backwards(each(at, from_end)));
    CHECK(worst_difference(backwards(found), Spline(t, y)(at)) <= 1e-11);
  }
}

TEST_CASE("no curve through the knots bends less") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto t = irregular_stamps(4 + random() % 40, random);
    const Spline s(t, random_values(t.size(), random));
    // The energy of the spline, and of one through the same knots and one more that is off the
    // curve. The energy is the integral of the squared second derivative, which is a straight line
    // between knots.
    const auto energy = [](const Spline& one) {
      double sum = 0.0;
      for (std::size_t i = 0; i + 1 < one.times.size(); ++i) {
        const double a = one.bends[i], b = one.bends[i + 1];
        sum += (one.times[i + 1] - one.times[i]) * (a * a + a * b + b * b) / 3.0;
      }
      return sum;
    };
    const std::size_t i = random() % (t.size() - 1);
    const double place = (t[i] + t[i + 1]) / 2.0;
    for (const double off : {-0.1, 0.1}) {
      Values times = t, values = s.values;
      const auto behind = static_cast<std::ptrdiff_t>(i + 1);
      times.insert(times.begin() + behind, place);
      values.insert(values.begin() + behind, s({place})[0] + off);
      CHECK(energy(Spline(times, values)) > energy(s));
    }
  }
}
