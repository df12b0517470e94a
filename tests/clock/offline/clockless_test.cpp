// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/clockless.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

HostTime at(Duration d) { return HostTime{100s + d}; }

}  // namespace

TEST_CASE("a stamp is T2 less half of what the host waited for the confirmation") {
  const std::vector<ClocklessExchange> exchanges{
      {0, at(40ms), at(41ms), at(107ms)},  // d = 33 ms
      {1, at(107ms), at(108ms), std::nullopt},
      {2, at(150ms), at(151ms), at(191ms)}};  // d = 20 ms
  CHECK(one_way_delay(exchanges[0]) == 33ms);
  CHECK(!one_way_delay(exchanges[1]));
  const auto each = stamps_by_each_delay(exchanges);
  CHECK(each[0] == at(7ms));
  CHECK(!each[1]);
  CHECK(each[2] == at(130ms));
  const auto mean = stamps_by_mean_delay(exchanges);
  REQUIRE(mean);
  CHECK((*mean)[1] == at(107ms - 26500us));
}

TEST_CASE("without a confirmation there is no d, and no stamp is made up") {
  const std::vector<ClocklessExchange> exchanges{{0, at(0s), at(1ms), std::nullopt}};
  CHECK(!stamps_by_mean_delay(exchanges));
  CHECK(!stamps_by_frame_number(exchanges, 15.0));
  CHECK(!stamps_by_frame_number({}, 15.0));
}

TEST_CASE("over the frame's number only the earliest arrivals count, lost frames shift nothing") {
  std::vector<ClocklessExchange> exchanges;
  for (std::uint64_t k = 0; k < 300; ++k) {
    if (k % 7 == 3) continue;  // lost
    const Duration sent{static_cast<std::int64_t>(1e9 / 15.0 * 1.00001 * static_cast<double>(k))};
    const Duration way = k % 5 == 0 ? 2ms : 2ms + 10ms * static_cast<int>(k % 11);
    exchanges.push_back({k, at(sent + way), at(sent + way + 1ms), at(sent + way + 1ms + 4ms)});
  }
  const auto stamps = stamps_by_frame_number(exchanges, 15.0);
  REQUIRE(stamps);
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    const double sent = 1.00001 / 15.0 * static_cast<double>(exchanges[i].frame);
    if (exchanges[i].frame > 290) continue;  // after the last early frame
    CHECK(std::abs(seconds((*stamps)[i] - at(0s)) - sent) < 20e-6);
  }
}
