// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/utc_anchor.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr Time noon = utc_time(1'790'000'000'000'000'000);

std::vector<ClockPair> a_minute(Duration stepped_by, Duration slewed_by_each) {
  std::vector<ClockPair> pairs;
  for (int i = 0; i < 60; ++i) {
    const Duration moved = (i >= 30 ? stepped_by : 0s) + i * slewed_by_each;
    pairs.push_back({HostTime{500s + i * 1s}, noon + i * 1s + moved});
  }
  return pairs;
}

}  // namespace

TEST_CASE("fault 17 host_step: an hour's step of the wall clock moves no stamp, and is reported") {
  for (const Duration step : {Duration{3600s}, Duration{-3600s}}) {
    const auto anchor = utc_anchor(a_minute(step, 0s));
    REQUIRE(anchor);
    CHECK(HostTime{555s}.time_since_epoch() + anchor->utc_minus_raw ==
          (noon + 55s).time_since_epoch());
    REQUIRE(anchor->steps.size() == 1);
    CHECK(anchor->steps[0].at == HostTime{530s});
    CHECK(anchor->steps[0].by == step);
  }
}

TEST_CASE("fault 18 host_slew: 500 ppm are no step and move no stamp") {
  const auto anchor = utc_anchor(a_minute(0s, 500us));
  REQUIRE(anchor);
  CHECK(anchor->steps.empty());
  CHECK(HostTime{555s}.time_since_epoch() + anchor->utc_minus_raw ==
        (noon + 55s).time_since_epoch());
}

TEST_CASE("without a pair there is no UTC") { CHECK(!utc_anchor({})); }
