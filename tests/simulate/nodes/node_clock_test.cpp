// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/node_clock.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

TEST_CASE("the clock of seed 1 reads what the reference's does") {
  const SimulatedClock clock(1, 60.0);  // the reference prints nine decimals
  CHECK(clock.reading(0.0) == doctest::Approx(5.0).epsilon(1e-12));
  CHECK(std::abs(clock.reading(10.0) - 15.000160441) < 6e-10);
  CHECK(std::abs(clock.reading(60.0) - 65.000947004) < 6e-10);
}

TEST_CASE("the host's time of a reading is the time at which it was read") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    const SimulatedClock clock(seed, 60.0);
    for (double t = 0.05; t < 60.0; t += 0.37) {
      CHECK(std::abs(clock.host(clock.reading(t)) - t) < 1e-12 * 100.0);
    }
  }
}

TEST_CASE("drawn clocks keep to 20 ppm and what warming adds, and bend by less than assumed") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    const SimulatedClock clock(seed, 600.0);
    double last = 0.0;
    for (double t = 0.0; t < 600.0; t += 10.0) {
      const double rate = (clock.reading(t + 10.0) - clock.reading(t)) / 10.0 - 1.0;
      CHECK(std::abs(rate) < 24e-6);
      if (t > 0.0) CHECK(std::abs(rate - last) / 10.0 < 5e-8);
      last = rate;
    }
  }
}

TEST_CASE("a clock without temperature and of stated error and ramp runs as stated") {
  const SimulatedClock clock(3, 100.0,
                             {.frequency_error = 50e-6, .temperature = false, .ramp = 1e-7});
  // 5 s + t + 50 ppm t + 1e-7 t^2 / 2, except for noise of some nanoseconds and the grid of 0.1 s.
  CHECK(std::abs(clock.reading(100.0) - (105.0 + 5e-3 + 5e-4)) < 1e-6);
}
