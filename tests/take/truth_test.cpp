// SPDX-License-Identifier: Apache-2.0
#include "kinalign/take/truth.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a true time lies on the line between its neighbours, and goes on beyond the last") {
  const std::int64_t utc = 1'790'000'000'000'000'000;
  const TrueClock clock{{0, 1'000'000'000, 2'000'000'000},
                        {utc, utc + 1'000'000'100, utc + 2'000'000'400}};
  CHECK(to_ns(true_time(clock, utc_time(0)).value()) == utc);
  CHECK(to_ns(true_time(clock, utc_time(500'000'000)).value()) == utc + 500'000'050);
  CHECK(to_ns(true_time(clock, utc_time(1'000'000'000)).value()) == utc + 1'000'000'100);
  CHECK(to_ns(true_time(clock, utc_time(1'500'000'000)).value()) == utc + 1'500'000'250);
  CHECK(to_ns(true_time(clock, utc_time(3'000'000'000)).value()) == utc + 3'000'000'700);
  CHECK(to_ns(true_time(clock, utc_time(-1'000'000'000)).value()) == utc - 1'000'000'100);
}

TEST_CASE("fewer than two pairs give no line") {
  CHECK(!true_time({}, utc_time(5)));
  CHECK(!true_time({{1}, {1}}, utc_time(5)));
}

TEST_CASE("a suit's frames are evenly spaced from its first one") {
  const TrueMocap mocap{"mocap", 60.0, 100, 0, 0, 1'000};
  CHECK(mocap.frame_ns(0) == 1'000);
  CHECK(mocap.frame_ns(3) == 50'001'000);
}
