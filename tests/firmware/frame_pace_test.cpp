// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/frame_pace.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

/// The times at which a sender that asks every microsecond from 0 on sends its frames.
std::vector<std::uint64_t> sends(std::uint32_t period_us, std::uint32_t dither_us,
                                 std::uint32_t seed) {
  FramePace pace(period_us, dither_us, seed);
  std::vector<std::uint64_t> at;
  for (std::uint64_t now = 0; now < 2'000'000; now = std::max(now + 1, pace.next_us())) {
    if (!pace.due(now)) continue;
    at.push_back(now);
    CHECK(pace.advance(now));
  }
  return at;
}

}  // namespace

TEST_CASE("frames come at the middle of their periods, each up to the dither later") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    const auto at = sends(50'000, 1'000, static_cast<std::uint32_t>(seed));
    REQUIRE(at.size() == 40);
    std::uint64_t least = 1'000, most = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::uint64_t late = at[i] - (25'000 + 50'000 * i);
      CHECK(late < 1'000);
      least = std::min(least, late);
      most = std::max(most, late);
    }
    CHECK(most - least > 500);  // 40 draws all in one half: once in 10^10
  }
}

TEST_CASE("the dither comes again with its seed, and differs between seeds") {
  CHECK(sends(50'000, 1'000, 7) == sends(50'000, 1'000, 7));
  CHECK(sends(50'000, 1'000, 7) != sends(50'000, 1'000, 8));
}

TEST_CASE("frames whose time is over are left out, and the grid stays") {
  FramePace pace(100, 0, 1);
  CHECK(!pace.due(0));
  CHECK(pace.due(50));
  CHECK(pace.advance(50));
  CHECK(pace.due(480));
  CHECK(!pace.advance(480));  // the frames of 250, 350 and 450 are left out
  CHECK(pace.next_us() == 550);
}

TEST_CASE("a counter that goes back does not stop frames") {
  FramePace pace(100, 0, 1);
  CHECK(!pace.due(1'000'000));
  CHECK(!pace.due(0));
  CHECK(pace.next_us() == 50);
}
