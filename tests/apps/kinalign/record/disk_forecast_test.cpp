// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/disk_forecast.h"

#include <doctest/doctest.h>

#include <algorithm>
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

TEST_CASE(
    "a rate that rises counts at once, after five seconds alone, and one that falls in the end") {
  DiskForecast forecast;
  std::uint64_t written = 0;
  const auto minutes_at = [&](double rate_mib_s) { return 600.0 / rate_mib_s / 60.0; };
  for (int s = 0; s <= 28; ++s) forecast.look(at_s(s), written, 664 * mebibyte);
  CHECK(!forecast.minutes_left());
  for (int s = 29; s <= 60; ++s) {
    written += mebibyte / 8;
    forecast.look(at_s(s), written, 664 * mebibyte);
    CAPTURE(s);
    REQUIRE(forecast.minutes_left());
    // The part of the last five seconds in which bytes were written.
    const double share = std::min(1.0, (s - 28) / 5.0);
    CHECK(*forecast.minutes_left() == doctest::Approx(minutes_at(share / 8)));
  }
  for (int s = 61; s <= 100; ++s) {
    written += mebibyte / 80;
    forecast.look(at_s(s), written, 664 * mebibyte);
    CAPTURE(s);
    const bool held = s <= 90;  // half a minute after the last fast second
    if (held) CHECK(*forecast.minutes_left() == doctest::Approx(minutes_at(1.0 / 8)));
    if (s >= 95)
      CHECK(*forecast.minutes_left() == doctest::Approx(minutes_at(1.0 / 80)).epsilon(1e-4));
  }
}

TEST_CASE("what comes by fits and starts is foretold by these, without leaping to and fro") {
  DiskForecast forecast;
  for (int s = 0; s <= 120; ++s) {
    forecast.look(at_s(s), s / 10 * mebibyte, 664 * mebibyte);  // a MiB each ten seconds
    CAPTURE(s);
    if (s >= 10) CHECK(*forecast.minutes_left() == doctest::Approx(600.0 * 5 / 60));
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
