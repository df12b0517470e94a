// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/parallel.h"

#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace kinalign;

TEST_CASE("each index is visited once, whatever the number of jobs") {
  for (const std::size_t jobs : {0, 1, 2, 3, 8, 100}) {
    for (const std::size_t count : {0, 1, 2, 7, 1000}) {
      std::vector<int> visits(count, 0);
      parallel_for(count, jobs, [&](std::size_t i) { ++visits[i]; });
      CHECK(visits == std::vector<int>(count, 1));
    }
  }
}

TEST_CASE("one job runs in order on the caller's thread") {
  const auto caller = std::this_thread::get_id();
  std::vector<std::size_t> order;
  parallel_for(5, 1, [&](std::size_t i) {
    CHECK(std::this_thread::get_id() == caller);
    order.push_back(i);
  });
  CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("two jobs run side by side") {
  std::atomic<int> here{0};
  // Each piece waits for the other: with one thread this would never end.
  parallel_for(2, 2, [&](std::size_t) {
    ++here;
    while (here < 2) std::this_thread::yield();
  });
  CHECK(here == 2);
}

TEST_CASE("what a body throws reaches the caller when the others are done") {
  for (const std::size_t jobs : {1, 2, 8}) {
    std::atomic<int> done{0};
    const auto body = [&](std::size_t i) {
      if (i == 0) throw std::runtime_error("no memory");
      ++done;
    };
    CHECK_THROWS_WITH_AS(parallel_for(8, jobs, body), "no memory", std::runtime_error);
    CHECK(done == (jobs == 1 ? 0 : 7));
  }
}
