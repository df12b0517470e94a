// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_latency.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

TEST_CASE("percentiles of the latencies 1 to 100 ms: p50 is 50, p99 is 99") {
  LiveLatency latency;
  for (int i = 100; i >= 1; --i) latency.add(i * 1ms, i * 2ms);
  CHECK(latency.after_arrival_ms(0.5) == doctest::Approx(50.0));
  CHECK(latency.after_arrival_ms(0.99) == doctest::Approx(99.0));
  CHECK(latency.behind_motion_ms(0.5) == doctest::Approx(100.0));
}

TEST_CASE("the newest frames alone are asked for, and no frames have no latency") {
  LiveLatency latency;
  CHECK(latency.after_arrival_ms(0.99) == 0.0);
  for (int i = 1; i <= 100; ++i) latency.add(i * 1ms, 0ms);
  CHECK(latency.after_arrival_ms(0.5, 10) == doctest::Approx(95.0));
}
