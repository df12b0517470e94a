// SPDX-License-Identifier: Apache-2.0
// Rules for any number of pieces of work on any number of threads.
#include "tests/seeds.h"

#include "kinalign/core/parallel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace kinalign;

TEST_CASE("no more bodies run at a time than there are jobs, and none when the call has returned") {
  for (const auto seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t jobs = random() % 9, count = random() % 200;
    std::atomic<int> running{0}, most{0}, done{0};
    parallel_for(count, jobs, [&](std::size_t i) {
      const int now = ++running;
      for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) continue;
      for (std::size_t k = 0; k < i % 7; ++k) std::this_thread::yield();
      ++done;
      --running;
    });
    CHECK(running == 0);
    CHECK(done == static_cast<int>(count));
    CHECK(most <= static_cast<int>(std::max<std::size_t>(jobs, 1)));
  }
}

TEST_CASE("whichever bodies throw, one of theirs is thrown, and nothing runs twice or afterwards") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t jobs = 1 + random() % 6, count = 1 + random() % 60;
    std::vector<int> throws(count), visits(count);
    for (int& one : throws) one = random() % 5 == 0 ? 1 : 0;
    throws[random() % count] = 1;
    std::string thrown;
    try {
      parallel_for(count, jobs, [&](std::size_t i) {
        ++visits[i];
        if (throws[i] != 0) throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      thrown = error.what();
    }
    REQUIRE_FALSE(thrown.empty());
    const std::size_t from = std::stoul(thrown);
    REQUIRE(from < count);
    CHECK(throws[from] == 1);
    CHECK(visits[from] == 1);
    int begun = 0;
    for (const int n : visits) {
      CHECK(n <= 1);
      begun += n;
    }
    // With one job the first piece in order begins first, and is the last one to run.
    if (jobs == 1) CHECK(begun == static_cast<int>(from) + 1);
  }
}

TEST_CASE("work may itself be divided, and the result does not depend on the number of threads") {
  const auto table = [](std::size_t jobs) {
    std::vector<std::size_t> out(30 * 40);
    parallel_for(30, jobs, [&](std::size_t i) {
      parallel_for(40, jobs, [&, i](std::size_t k) { out[i * 40 + k] = i * i + 3 * k; });
    });
    return out;
  };
  const auto expected = table(1);
  for (const std::size_t jobs : {2, 3, 8}) CHECK(table(jobs) == expected);
}
