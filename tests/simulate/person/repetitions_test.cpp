// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/repetitions.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace kinalign;

TEST_CASE("repetitions fill their span one behind the other, with lengths of their own") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    const auto all = drawn_repetitions({10.0, 55.0, 6.0, -1.0, 3}, seed);
    REQUIRE(all.size() == 7);
    CHECK(all.front().begin_s == 10.0);
    CHECK(all.back().end_s == about(55.0));
    std::set<double> lengths;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double length = all[i].end_s - all[i].begin_s;
      lengths.insert(length);
      CHECK(length > 0.8 / 1.2 * 45.0 / 7.0);
      CHECK(length < 1.2 / 0.8 * 45.0 / 7.0);
      CHECK(all[i].amplitude >= 0.85);
      CHECK(all[i].amplitude <= 1.15);
      CHECK(all[i].side == (i % 2 == 0 ? -1.0 : 1.0));
      if (i > 0) CHECK(all[i].begin_s == all[i - 1].end_s);
    }
    CHECK(lengths.size() == 7);
  }
}

TEST_CASE("a span shorter than a repetition has one") {
  CHECK(drawn_repetitions({0.0, 3.0, 6.0, 1.0, 0}, 1).size() == 1);
}

TEST_CASE("a repetition is 0 at its ends and its amplitude in the pause, and never beyond") {
  const auto all = drawn_repetitions({0.0, 60.0, 6.0, 1.0, 0}, 5);
  for (const Repetition& one : all) {
    CHECK(one.size(one.begin_s) == 0.0);
    CHECK(one.size(one.end_s) == 0.0);
    const double pause =
        one.begin_s + 0.5 * (one.forth + 1.0 - one.back) * (one.end_s - one.begin_s);
    CHECK(one.size(pause) == one.amplitude);
    for (double t = one.begin_s; t < one.end_s; t += 0.01) CHECK(one.size(t) <= one.amplitude);
  }
}

TEST_CASE("the repetition at a time is the one that it lies in, outside all the nearest") {
  const auto all = drawn_repetitions({0.0, 60.0, 6.0, 1.0, 0}, 5);
  CHECK(&repetition_at(all, -1.0) == &all.front());
  CHECK(&repetition_at(all, 99.0) == &all.back());
  CHECK(&repetition_at(all, all[3].begin_s) == &all[3]);
  CHECK(&repetition_at(all, std::nextafter(all[3].begin_s, 0.0)) == &all[2]);
}
