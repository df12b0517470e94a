// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/floor_log.h"

#include "tests/about.h"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace kinalign;

namespace {

/// Ten packets a second each way that take 1 ms and a random delay; the offset steps at 100 s.
struct Told {
  FloorLog log;
  std::optional<double> step;  // the first
};

Told log_of(double until, double step, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> delay(1000.0);
  Told told;
  FloorLog& log = told.log;
  for (double s = 0.0; s < until; s += 0.1) {
    const double x = 1e-5 * s + (s >= 100.0 ? step : 0.0);
    log.add({s, x + 1e-3 + delay(random), Side::above}, {1e-5, 1e-6});
    log.add({s, x - 1e-3 - delay(random), Side::below}, {1e-5, 1e-6});
    if (!told.step) told.step = log.step();
  }
  return told;
}

}  // namespace

TEST_CASE("a window gives the least round trip and the offset between the floors") {
  const FloorLog log = log_of(25.0, 0.0, 1).log;
  REQUIRE(log.window(0));
  CHECK(log.window(0)->s == 15.0);
  CHECK(log.window(0)->round_trip == about(2e-3, 0.05));
  CHECK(log.window(0)->middle == about(1e-5 * 15.0, 0.2));
  CHECK(log.windows() == 2);
}

TEST_CASE("a step of a millisecond shows within two windows, and nothing shows without one") {
  CHECK(!log_of(200.0, 0.0, 2).step);
  const auto by = log_of(120.5, 1e-3, 2).step;
  REQUIRE(by);
  CHECK(*by == about(1e-3, 0.1));
}

TEST_CASE("an interval may be as narrow as a route that was left, once two windows agree on that") {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> delay(1e4);
  struct Case {
    double left_at, second_ms, least_ms;
  };
  // Three windows agree on 6 ms. Before them one window saw 2 ms, or two windows that do not agree,
  // or two that do.
  for (const auto& [left_at, second_ms, least_ms] :
       {Case{10.0, 4.0, 6.0}, Case{20.0, 1.0, 6.0}, Case{20.0, 0.0, 2.0}}) {
    CAPTURE(left_at);
    CAPTURE(second_ms);
    FloorLog log;
    for (double s = 0.0; s < 65.0; s += 0.1) {
      const double longer = s < 10.0 ? 0.0 : s < left_at ? second_ms * 1e-3 : 4e-3;  // one way
      log.add({s, 1e-3 + longer + delay(random), Side::above}, {0.0, 1e-6});
      log.add({s, -1e-3 - delay(random), Side::below}, {0.0, 1e-6});
      if (s > left_at + 3.0 && s < left_at + 3.1) log.change_route(left_at);
    }
    CHECK(log.least_width() == about(0.8e-3 * least_ms, 0.05));
  }
}

TEST_CASE("a window with few packets is none") {
  FloorLog log;
  for (double s = 0.0; s < 40.0; s += 0.1) {
    log.add({s, 1e-3, Side::above}, {0.0, 1e-6});
    if (s < 20.0) log.add({s, -1e-3, Side::below}, {0.0, 1e-6});
  }
  CHECK(!log.window(0));
  CHECK(log.window(2));
}

TEST_CASE("an interval can't be narrower than the least that three round trips agree on") {
  const auto least_of = [](const std::vector<FloorWindow>& windows) {
    ShortestRoundTrips shortest;
    for (const FloorWindow& window : windows) shortest.add(window);
    return shortest.least_width();
  };
  const auto trip = [](double s, double gap) { return FloorWindow{0.0, 0.0, s, gap}; };
  CHECK(least_of({trip(10e-3, 0.0), trip(10e-3, 0.0)}) == 0.0);
  // The width is the round trip minus a fifth, …
  CHECK(least_of({trip(10e-3, 0.0), trip(10e-3, 0.0), trip(10e-3, 0.0)}) == about(8e-3));
  // … or minus 20 us, the error that schedulers cause, …
  CHECK(least_of({trip(50e-6, 0.0), trip(50e-6, 0.0), trip(50e-6, 0.0)}) == about(30e-6));
  // … or minus twice the floors' error and three times the difference of the three.
  CHECK(least_of({trip(10e-3, 0.5e-3), trip(11e-3, 0.2e-3), trip(10.5e-3, 0.1e-3)}) ==
        about(10e-3 - 2 * 0.5e-3 - 3 * 1e-3));
  // Three must agree within a twentieth plus three times the floors' error. One or two shorter ones
  // are ignored.
  CHECK(least_of({trip(10e-3, 0.0), trip(10.4e-3, 0.0), trip(10.6e-3, 0.0)}) == 0.0);
  CHECK(least_of({trip(2e-3, 0.0), trip(3e-3, 0.0), trip(10e-3, 0.0), trip(10e-3, 0.0),
                  trip(10e-3, 0.0)}) == about(8e-3));
  CHECK(least_of({trip(2e-3, 0.0), trip(3e-3, 0.0), trip(4e-3, 0.0), trip(10e-3, 0.0),
                  trip(10e-3, 0.0), trip(10e-3, 0.0)}) == 0.0);
}

/// The step that is found if packets come from 0 to 60 s, and again for 60 s after a silence. The
/// slope differs by `slope` from the expected one, and the offset steps by `step` 2 s after the
/// silence.
std::optional<double> step_over_silence(double silent_s, double slope, double step) {
  std::mt19937_64 random(4);
  std::exponential_distribution<double> delay(1e5);
  FloorLog log;
  std::optional<double> found;
  for (double s = 0.0; s < 120.0 + silent_s; s += 0.1) {
    if (s > 60.0 && s < 60.0 + silent_s) continue;
    const double x = slope * s + (s >= 62.0 + silent_s ? step : 0.0);
    log.add({s, x + 1e-3 + delay(random), Side::above}, {0.0, 1e-6});
    log.add({s, x - 1e-3 - delay(random), Side::below}, {0.0, 1e-6});
    if (!found) found = log.step();
  }
  return found;
}

TEST_CASE("over a silence a crystal may have warmed, and a greater step than that still shows") {
  for (const double silent_s : {25.0, 90.0, 200.0, 600.0}) {
    CAPTURE(silent_s);
    CHECK(!step_over_silence(silent_s, 3e-6, 0.0));  // 2 ms in ten minutes
    const auto by = step_over_silence(silent_s, 0.0, 15e-3);
    REQUIRE(by);
    CHECK(*by == about(15e-3, 0.1));
    if (silent_s < 100.0) CHECK(step_over_silence(silent_s, 0.0, 1.5e-3));
  }
}
