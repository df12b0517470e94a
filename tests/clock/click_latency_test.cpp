// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/click_latency.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

std::vector<ClickPair> pairs_of(std::initializer_list<Duration> lags) {
  std::vector<ClickPair> pairs;
  HostTime click{1000s};
  for (const Duration lag : lags) pairs.push_back({click += 10s, click + lag});
  return pairs;
}

}  // namespace

TEST_CASE("median and spread of a few pairs are those of a table") {
  const auto found = click_latency(pairs_of({40ms, 44ms, 45ms, 47ms, 50ms, 90ms}));
  REQUIRE(found);
  CHECK(found->median == 46ms);
  // Deviations 1 1 2 4 6 44 ms: their median is 3 ms.
  CHECK(found->spread == Duration{std::llround(1.4826 * 3e6)});
  CHECK(found->low == 40ms);  // six coins all fall alike in 3 % of the cases
  CHECK(found->high == 90ms);
}

TEST_CASE("five pairs are too few for an interval") {
  CHECK(!click_latency(pairs_of({40ms, 44ms, 45ms, 47ms, 50ms})));
}

TEST_CASE("the interval holds the median in 95 of 100 cases at least") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> jitter(0.045, 0.006);
    std::uniform_real_distribution<double> frame(0.0, 1.0 / 60.0);
    int held = 0;
    constexpr int trials = 2000;
    for (int i = 0; i < trials; ++i) {
      std::vector<ClickPair> pairs;
      for (int k = 0; k < 20; ++k) {
        const Duration lag{std::llround((jitter(random) + frame(random)) * 1e9)};
        pairs.push_back({HostTime{}, HostTime{lag}});
      }
      const auto found = click_latency(pairs);
      // 45 ms and half a frame: the median of a symmetric law.
      const double truth = 0.045 + 0.5 / 60.0;
      held += seconds(found->low) <= truth && truth <= seconds(found->high) ? 1 : 0;
    }
    CHECK(held > static_cast<int>(0.94 * trials));  // five deviations below 0.959
  }
}

TEST_CASE("clicks and counts of frames give the step and the latencies' difference") {
  std::vector<ClickedTake> takes;
  for (const std::uint64_t frames : {1200U, 3600U, 7200U}) {
    const Duration length{std::llround((static_cast<double>(frames) / 60.0 + 0.012) * 1e9)};
    takes.push_back({HostTime{5s}, HostTime{5s + length}, frames});
  }
  const auto found = clicked_step(takes);
  REQUIRE(found);
  CHECK(found->step_s == about(1.0 / 60.0, 1e-9));
  CHECK(found->latency_difference_s == about(0.012, 1e-6));
  CHECK(found->step_deviation_s < 1e-9);
  takes[1].frames = takes[2].frames = takes[0].frames;
  CHECK(!clicked_step(takes));
}

TEST_CASE("a step's stated deviation is how far it lies off") {
  // Twenty takes of 20 to 120 s with 6 ms of jitter at each click give a frame's step to 79 ppm.
  for (const auto seed : fresh_seeds(2)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> jitter(0.0, 0.006);
    std::uniform_real_distribution<double> length(20.0, 120.0), part(0.0, 1.0 / 60.0);
    double squares = 0.0, stated = 0.0;
    constexpr int trials = 1000;
    for (int i = 0; i < trials; ++i) {
      std::vector<ClickedTake> takes;
      for (int k = 0; k < 20; ++k) {
        const auto frames = static_cast<std::uint64_t>(length(random) * 60.0);
        const double clicked =
            static_cast<double>(frames) / 60.0 + part(random) + jitter(random) - jitter(random);
        takes.push_back({HostTime{}, HostTime{Duration{std::llround(clicked * 1e9)}}, frames});
      }
      const auto found = clicked_step(takes);
      squares += std::pow(found->step_s * 60.0 - 1.0, 2) / trials;
      stated += std::pow(found->step_deviation_s * 60.0, 2) / trials;
    }
    CHECK(std::sqrt(squares) == about(79e-6, 0.12));
    CHECK(std::sqrt(stated) == about(std::sqrt(squares), 0.12));
  }
}
