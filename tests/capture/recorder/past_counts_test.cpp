// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/past_counts.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a take's counts begin with what had come before its first chunk") {
  PastCounts<int> past;
  CHECK(past.before(5) == 0);  // nothing had come
  for (std::uint64_t k = 10; k <= 20; ++k) past.remember(k, k - 5, static_cast<int>(100 * k));
  CHECK(past.before(15) == 1500);
  CHECK(past.before(20) == 2000);
  CHECK(past.before(14) == 0);  // forgotten, because no take can begin there any more
}
