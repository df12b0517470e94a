// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/disk_forecast.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

namespace {

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;

HostTime at_s(int s) { return HostTime{std::chrono::seconds(s)}; }

}  // namespace

TEST_CASE("the minutes left are those until the reserve, at the rate of the last half minute") {
  DiskForecast forecast;
  CHECK(!forecast.minutes_left());
  CHECK(!forecast.full());
  for (int s = 0; s <= 10; ++s) forecast.look(at_s(s), s * mebibyte, 664 * mebibyte);
  REQUIRE(forecast.minutes_left());
  CHECK(*forecast.minutes_left() == doctest::Approx(10.0));  // 600 MiB at 1 MiB/s
  // ten times as fast from here on: after the half minute nothing else counts
  for (int s = 11; s <= 45; ++s) {
    forecast.look(at_s(s), (10 + 10 * (s - 10)) * mebibyte, 664 * mebibyte);
  }
  CHECK(*forecast.minutes_left() == doctest::Approx(1.0));
}

TEST_CASE("nothing is foretold where nothing comes") {
  DiskForecast forecast;
  for (int s = 0; s <= 10; ++s) forecast.look(at_s(s), 5, 664 * mebibyte);
  CHECK(!forecast.minutes_left());
  CHECK(!forecast.take_warning());
}

TEST_CASE("a disk is full where only the reserve of 64 MiB is left") {
  DiskForecast forecast;
  forecast.look(at_s(0), 0, 64 * mebibyte + 1);
  CHECK(!forecast.full());
  forecast.look(at_s(1), 1, 64 * mebibyte);
  CHECK(forecast.full());
}

TEST_CASE("it is warned of at 10, 5, 2 and 1 minutes, each once") {
  DiskForecast forecast;
  std::uint64_t free = 64 * mebibyte + 11 * 60 * mebibyte;  // 11 minutes of 1 MiB/s
  std::vector<int> warned;
  for (int s = 0; s <= 11 * 60; ++s, free -= mebibyte) {
    forecast.look(at_s(s), s * mebibyte, free);
    if (forecast.take_warning()) warned.push_back(11 * 60 - s);
  }
  CHECK(warned == std::vector<int>{600, 300, 120, 60});
}
