// SPDX-License-Identifier: Apache-2.0
// Rules for any stamps, however they jump.
#include "tests/seeds.h"

#include "kinalign/motion/stamps.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

using Stamps = std::vector<Time>;

Duration milliseconds(double ms) { return Duration{std::llround(ms * 1e6)}; }

/// A stream of about 30 Hz in which one sample in eight is repeated, steps back, leaps ahead or is
/// late.
Stamps messy_stamps(std::mt19937_64& random) {
  std::uniform_real_distribution<double> step(20.0, 45.0), any(0.0, 1.0);
  Stamps out;
  double t = 0.0;
  for (std::size_t n = random() % 400; out.size() < n; t += step(random)) {
    double given = t;
    switch (random() % 40) {
      case 0:
        given = t - 1000.0 * any(random);
        break;
      case 1:
        given = t + 1e4 * any(random);
        break;
      case 2:
        given = t + 1e9 * any(random);
        break;
      case 3:
        given = t + 40.0 * any(random);
        break;
      case 4:
        t += 5000.0 * any(random);
        break;  // a gap
      default:
        break;
    }
    out.push_back(utc_time(1'790'000'000'000'000'000) + milliseconds(given));
    if (random() % 40 == 0) out.push_back(out.back());
  }
  return out;
}

/// The stamps that StampRule keeps.
Stamps kept_of(const Stamps& stamps) {
  StampRule rule;
  Stamps kept;
  for (const Time stamp : stamps) {
    const StampFate fate = rule.judge(stamp);
    if (fate == StampFate::replaces) kept.pop_back();
    if (fate == StampFate::kept || fate == StampFate::replaces) kept.push_back(stamp);
  }
  return kept;
}

StampSurvey survey(const Stamps& stamps) {
  StampSurveyor surveyor;
  surveyor.add(stamps);
  return surveyor.result();
}

}  // namespace

TEST_CASE("whatever the stamps, the kept ones rise, and the survey describes exactly these") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Stamps stamps = messy_stamps(random), kept = kept_of(stamps);
    for (std::size_t i = 1; i < kept.size(); ++i) CHECK(kept[i - 1] < kept[i]);
    const StampSurvey found = survey(stamps);
    CHECK(found.samples == stamps.size());
    REQUIRE(found.kept() == kept.size());
    if (kept.empty()) continue;
    CHECK(found.first == kept.front());
    CHECK(found.last == kept.back());
    std::vector<std::int64_t> steps;
    for (std::size_t i = 1; i < kept.size(); ++i) steps.push_back((kept[i] - kept[i - 1]).count());
    if (steps.empty()) continue;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    CHECK(static_cast<double>(found.median_step_ns) ==
          doctest::Approx(static_cast<double>(*middle)).epsilon(0.01));
  }
}

TEST_CASE("a sample of which the rule is sure is never taken back") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    StampRule rule;
    bool may_be_replaced = false;
    for (const Time stamp : messy_stamps(random)) {
      const bool replaces = rule.judge(stamp) == StampFate::replaces;
      CHECK((!replaces || may_be_replaced));
      may_be_replaced = rule.pending();
    }
  }
}

TEST_CASE("a stream has the same fate whenever it was recorded") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Stamps stamps = messy_stamps(random);
    const auto shift = Duration{static_cast<std::int64_t>(random() >> 3) - (1LL << 60)};
    StampRule rule, shifted;
    for (const Time stamp : stamps) CHECK(rule.judge(stamp) == shifted.judge(stamp + shift));
  }
}

TEST_CASE(
    "a rising stream whose steps differ by less than the leap of a wild stamp loses nothing") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const double scale = std::exp(std::uniform_real_distribution<double>(5.0, 25.0)(random));
    std::uniform_real_distribution<double> step(scale, 4.9 * scale);
    Stamps stamps{utc_time(static_cast<std::int64_t>(random() % 1'000'000))};
    while (stamps.size() < 300)
      stamps.push_back(stamps.back() + Duration{std::llround(step(random))});
    CHECK(kept_of(stamps) == stamps);
    CHECK(survey(stamps).kept() == stamps.size());
  }
}

TEST_CASE("one wild stamp anywhere in a steady stream costs itself alone") {
  for (const auto seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    Stamps stamps;
    for (int i = 0; i < 60; ++i) stamps.push_back(utc_time(i * 33'333'333LL));
    const std::size_t wild = random() % 59;  // after the last one nothing shows which one is wrong
    // Jumps of more than four usual steps. For the first two stamps no step is usual yet: more than
    // a second.
    std::uniform_real_distribution<double> digits(wild < 2 ? 9.1 : 8.2, 16.0);
    const auto size = std::llround(std::pow(10.0, digits(random)));
    Stamps others = stamps;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(wild));
    for (const std::int64_t jump : {size, -size}) {
      // A clock that was set forward looks the same. And the second stamp has already removed the
      // first one, before the third shows which of them was wrong.
      if (wild <= 1 && jump < 0) continue;
      Stamps given = stamps;
      given[wild] += Duration{jump};
      CAPTURE(wild);
      CAPTURE(jump);
      CHECK(kept_of(given) == others);
    }
  }
}

TEST_CASE(
    "a pause does not become the usual step: an implausible stamp right after it is reported") {
  Stamps stamps;
  for (int i = 0; i < 20; ++i) stamps.push_back(utc_time(i * 10'000'000LL));
  stamps.push_back(stamps.back() + Duration{30'000'000});  // three steps
  const Stamps steady = stamps;
  const Time wild = stamps.back() + Duration{85'000'000};  // more than four times two usual steps
  const Time next = stamps.back() + Duration{10'000'000};
  stamps.push_back(wild);
  stamps.push_back(next);
  Stamps expected = steady;
  expected.push_back(next);
  CHECK(kept_of(stamps) == expected);
}

TEST_CASE("frames of a fixed step stand where exact arithmetic puts them, to a nanosecond") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Time first = utc_time(1'790'000'000'000'000'000);
    const auto whole = static_cast<std::int64_t>(1 + random() % 1'000'000'000);
    const std::uint64_t frame = random() % 3'000'000;
    const auto stamp = [&](std::uint64_t k) {
      return frame_stamp(first, static_cast<double>(whole), k);
    };
    CHECK(stamp(frame) == first + Duration{whole * static_cast<std::int64_t>(frame)});
    const double step = std::uniform_real_distribution<double>(1e6, 1e8)(random);
    const long double exact = static_cast<long double>(step) * static_cast<long double>(frame);
    const auto found = (frame_stamp(first, step, frame) - first).count();
    CHECK(std::abs(static_cast<long double>(found) - exact) <= 0.6L);
  }
}
