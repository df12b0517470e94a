// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/time.h"

#include <doctest/doctest.h>

#include <functional>
#include <type_traits>

using namespace kinalign;

// Stamps of different clocks can't be mixed: such code does not compile.
static_assert(!std::is_invocable_v<std::minus<>, Time, NodeTime>);
static_assert(!std::is_invocable_v<std::minus<>, HostTime, NodeTime>);
static_assert(!std::is_invocable_v<std::less<>, Time, HostTime>);
static_assert(!std::is_convertible_v<std::int64_t, Time>);

TEST_CASE("a stamp survives the way through the integer of a file") {
  for (const std::int64_t ns : {INT64_MIN, std::int64_t{-1}, std::int64_t{0}, INT64_MAX}) {
    CHECK(to_ns(utc_time(ns)) == ns);
  }
}

TEST_CASE("the difference of two stamps of today is exact in seconds to a nanosecond") {
  const Time t = utc_time(1'790'000'000'000'000'000);
  CHECK(seconds((t + Duration{1}) - t) == 1e-9);
}
