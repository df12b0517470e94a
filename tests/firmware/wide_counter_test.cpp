// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/wide_counter.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a counter of 32 bits goes on past its turn") {
  WideCounter counter;
  CHECK(counter.widen(5) == 5);
  CHECK(counter.widen(0xffffffff) == 0xffffffff);
  CHECK(counter.widen(0) == 0x100000000);
  CHECK(counter.widen(0) == 0x100000000);
}

TEST_CASE("fault 6 counter_wrap32: asked once in any time below a turn, it is never wrong") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    WideCounter counter;
    std::uint64_t truth = 0;
    for (int i = 0; i < 100; ++i) {
      truth += random() % 0x100000000;
      REQUIRE(counter.widen(static_cast<std::uint32_t>(truth)) == truth);
    }
  }
}
