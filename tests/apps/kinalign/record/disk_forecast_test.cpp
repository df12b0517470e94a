// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/disk_forecast.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

namespace {

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;

HostTime at_s(int s) { return HostTime{std::chrono::seconds(s)}; }

}  // namespace

TEST_CASE("the minutes left are those until the reserve, at what comes") {
  DiskForecast forecast;
  CHECK(!forecast.minutes_left());
  CHECK(!forecast.full());
  for (int s = 0; s <= 10; ++s) forecast.look(at_s(s), s * mebibyte, 664 * mebibyte);
  REQUIRE(forecast.minutes_left());
  CHECK(*forecast.minutes_left() == doctest::Approx(10.0));  // 600 MiB at 1 MiB/s
  // From here on ten times as fast.
  for (int s = 11; s <= 45; ++s) {
    forecast.look(at_s(s), (10 + 10 * (s - 10)) * mebibyte, 664 * mebibyte);
  }
  CHECK(*forecast.minutes_left() == doctest::Approx(1.0));
}

TEST_CASE("data that comes in bursts is forecast by the mean of the last half minute") {
  DiskForecast forecast;
  for (int s = 0; s <= 120; ++s) {
    forecast.look(at_s(s), s / 10 * mebibyte, 664 * mebibyte);  // a MiB each ten seconds
    CAPTURE(s);
    if (s >= 30) CHECK(*forecast.minutes_left() == doctest::Approx(600.0 * 10 / 60));
  }
}

TEST_CASE("what a narrow terminal cuts off the disk's line is the path first") {
  DiskForecast forecast;
  const auto line = [&] { return disk_text(forecast, 34'200'000, "takes/03_S1A02_01.mcap"); };
  CHECK(line() == "disk  34.2 MB in takes/03_S1A02_01.mcap");
  constexpr std::uint64_t free = 120'500'000'000;
  forecast.look(at_s(0), 0, free);
  CHECK(line() == "disk  120.5 GB left; 34.2 MB in takes/03_S1A02_01.mcap");
  const auto at_rate = [&](std::uint64_t bytes_in_5_s) {
    forecast = {};
    forecast.look(at_s(0), 0, free);
    forecast.look(at_s(5), bytes_in_5_s, free);
    return line().substr(0, 39);  // the first 39 of 40 columns
  };
  CHECK(at_rate(10'000'000) == "disk  16.7 h left at this rate, 120.5 G");
  CHECK(at_rate(100'000'000) == "disk  100 min left at this rate, 120.5 ");
  CHECK(at_rate(100'000) == "disk  70 d left at this rate, 120.5 GB;");
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
