// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/time_model.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr Time at(std::int64_t ns) { return utc_time(ns); }

/// 5 s ahead from 100 s on, then 7 s ahead and 10 ppm fast from 200 s on, known to 3 ms.
TimeModel two_pieces() {
  TimeModel model;
  model.pieces = {{Time{100s}, 5s, 0.0, std::nullopt}, {Time{200s}, 7s, 10.0, 3ms}};
  return model;
}

}  // namespace

TEST_CASE("a shared clock changes no stamp and leaves no doubt") {
  const TimeModel model = shared_clock();
  for (const std::int64_t ns : {INT64_MIN, std::int64_t{-1}, std::int64_t{0}, INT64_MAX}) {
    CHECK(take_time(model, at(ns)) == at(ns));
    CHECK(half_width(model, at(ns)) == Duration{0});
  }
}

TEST_CASE("a model of which nothing is known changes no stamp and knows no interval") {
  CHECK(take_time(TimeModel{}, at(17)) == at(17));
  CHECK(!half_width(TimeModel{}, at(17)));
}

TEST_CASE("each piece holds from its beginning to the next one's, the first one before it too") {
  const TimeModel model = two_pieces();
  CHECK(take_time(model, Time{0s}) == Time{5s});
  CHECK(take_time(model, Time{100s}) == Time{105s});
  CHECK(take_time(model, Time{200s} - 1ns) == Time{205s} - 1ns);
  CHECK(take_time(model, Time{200s}) == Time{207s});
  CHECK(!half_width(model, Time{200s} - 1ns));
  CHECK(half_width(model, Time{200s}) == 3ms);
}

TEST_CASE("drift adds its millionths of the time since the piece's beginning") {
  const TimeModel model = two_pieces();
  CHECK(take_time(model, Time{300s}) == Time{307s + 1ms});
  TimeModel slow = model;
  slow.pieces[1].drift_ppm = -10.0;
  CHECK(take_time(slow, Time{300s}) == Time{307s - 1ms});
}

TEST_CASE("a drift since the beginning of time overflows nothing on the way") {
  TimeModel model;
  model.pieces = {{Time::min(), Duration{0}, 1e-6, std::nullopt}};
  const std::int64_t late = 4'000'000'000'000'000'000;
  const double since = 4e18 + 9223372036854775808.0;
  CHECK(std::abs(static_cast<double>(to_ns(take_time(model, at(late))) - late) - 1e-12 * since) <=
        1.0);
}

TEST_CASE("within a piece later stamps stay later") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    TimeModel model;
    model.pieces = {{at(1'700'000'000'000'000'000), Duration{static_cast<int>(random() % 1000)},
                     static_cast<double>(random() % 200) - 100.0, std::nullopt}};
    std::int64_t ns = 1'700'000'000'000'000'000;
    Time last = take_time(model, at(ns));
    for (int i = 0; i < 100; ++i) {
      ns += 1000 + static_cast<std::int64_t>(random() % 1'000'000'000'000);
      const Time now = take_time(model, at(ns));
      CHECK(now > last);
      last = now;
    }
  }
}
