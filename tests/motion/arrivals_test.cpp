// SPDX-License-Identifier: Apache-2.0
// Lateness of samples that were stamped on arrival, compared with the times at which they were
// taken.
#include "kinalign/motion/arrivals.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

constexpr std::int64_t ms = 1'000'000;

Arrivals arrivals(const std::vector<std::int64_t>& stamps, std::int64_t step_ns) {
  ArrivalSurveyor surveyor(step_ns);
  for (const std::int64_t t : stamps) surveyor.add(t);
  return surveyor.result();
}

/// Samples are taken each step. Those of [from, to) wait, and from `to` on one arrives each
/// `drain_ns` until none waits.
std::vector<std::int64_t> stalled(std::size_t count, std::int64_t step, std::size_t from,
                                  std::size_t to, std::int64_t drain_ns) {
  std::vector<std::int64_t> stamps;
  for (std::size_t k = 0; k < count; ++k) {
    std::int64_t t = static_cast<std::int64_t>(k) * step;
    if (k == from) t = static_cast<std::int64_t>(to) * step;
    if (k > from) t = std::max(t, stamps.back() + drain_ns);
    stamps.push_back(t);
  }
  return stamps;
}

}  // namespace

TEST_CASE("samples less than a fifth of a step in front of the next are counted") {
  const auto near_of = [](std::vector<std::int64_t> stamps) {
    for (std::int64_t& t : stamps) t *= ms;
    return arrivals(stamps, 30 * ms).near;
  };
  CHECK(near_of({0, 30, 60, 90, 145, 150, 180, 210}) == 1);  // 120 came at 145
  CHECK(near_of({0, 30, 60, 90, 144, 150, 180, 210}) == 0);
  CHECK(near_of({0, 1, 2, 30, 60, 90, 120, 150, 180, 210}) == 2);
}

TEST_CASE("without a pause only those are near that come within a twentieth of a step") {
  const auto near_of = [](std::int64_t apart) {
    std::vector<std::int64_t> stamps;
    for (std::int64_t k = 0; k < 20; ++k) stamps.push_back(100 * k * ms);
    for (std::int64_t k = 1; k < 9; ++k) stamps.push_back(1900 * ms + k * apart * ms);
    for (std::int64_t k = 1; k < 20; ++k) stamps.push_back((1900 + 8 * apart + 100 * k) * ms);
    return arrivals(stamps, 100 * ms).near;
  };
  CHECK(near_of(4) == 8);
  CHECK(near_of(6) == 2);  // by the two steps that may hide
  CHECK(near_of(14) == 2);
}

TEST_CASE("at the start only those are near that come within an eighth of a step") {
  const auto near_of = [](std::int64_t apart) {
    std::vector<std::int64_t> stamps;
    for (std::int64_t k = 0; k < 8; ++k) stamps.push_back(k * apart * ms);
    for (std::int64_t k = 1; k < 20; ++k) stamps.push_back((7 * apart + 100 * k) * ms);
    return arrivals(stamps, 100 * ms).near;
  };
  CHECK(near_of(12) == 7);
  CHECK(near_of(13) < 7);
}

TEST_CASE("what waited in a stall is counted, and how late the first of it was, is known") {
  for (const std::int64_t drain : {1, 3, 5, 8}) {
    CAPTURE(drain);
    const auto stamps = stalled(1000, 10 * ms, 300, 340, drain * ms);
    const Arrivals found = arrivals(stamps, 10 * ms);
    std::uint64_t late = 0;
    for (std::size_t k = 0; k < stamps.size(); ++k) {
      if (stamps[k] - static_cast<std::int64_t>(k) * 10 * ms >= late_steps * 10 * ms) ++late;
    }
    // 5 % of tolerance for each of up to 200 samples until no sample waits.
    CHECK(found.late <= late);
    CHECK(found.late >= late * 3 / 4 - 10);
    CHECK(found.worst_late_ns <= 400 * ms);
    CHECK(found.worst_late_ns >= 290 * ms);
  }
}

TEST_CASE("samples delayed before the first one was sent are reported, too") {
  const auto flushed = stalled(1000, 10 * ms, 0, 40, ms / 2);
  const Arrivals found = arrivals(flushed, 10 * ms);
  CHECK(found.late > 30);
  CHECK(found.first_late);
  CHECK(found.worst_late_ns >= 350 * ms);
  CHECK(!arrivals(stalled(1000, 10 * ms, 5, 40, ms / 2), 10 * ms).first_late);
}

TEST_CASE("a device that begins quicker than it goes on has not waited") {
  for (const std::int64_t quick : {4, 6, 30, 45}) {
    CAPTURE(quick);
    std::vector<std::int64_t> stamps{0};
    for (int k = 0; k < 240; ++k) stamps.push_back(stamps.back() + quick * ms);
    for (int k = 0; k < 1000; ++k) stamps.push_back(stamps.back() + 50 * ms);
    const Arrivals found = arrivals(stamps, 50 * ms);
    CHECK(found.late == 0);
    CHECK(found.near <= 3);  // with steps of 6 ms: the end of the stretch that could be a flush
    if (quick >= 10) CHECK(!found.first_late);
  }
}

TEST_CASE("a device that quickens, without a pause, has not waited") {
  for (const auto& [slow, quick] :
       {std::pair{66'667, 33'333}, {40'000, 28'571}, {20'000, 16'667}}) {
    for (const std::size_t slow_ones : {300, 1000}) {
      CAPTURE(slow);
      CAPTURE(slow_ones);
      std::vector<std::int64_t> stamps{0};
      for (std::size_t k = 0; k < slow_ones; ++k) stamps.push_back(stamps.back() + slow * 1000);
      for (int k = 0; k < 600; ++k) stamps.push_back(stamps.back() + quick * 1000);
      const std::int64_t median = 1000 * (slow_ones > 600 ? slow : quick);
      CHECK(arrivals(stamps, median) == Arrivals{});
    }
  }
}

TEST_CASE("without a known step only near samples are reported") {
  ArrivalSurveyor unsteady(10 * ms, false);
  for (const std::int64_t t : stalled(1000, 10 * ms, 300, 340, ms)) unsteady.add(t);
  CHECK(unsteady.result().late == 0);
  CHECK(unsteady.result().near > 30);
}

TEST_CASE("bursts at the stated rate are late by what the last one of each shows") {
  std::vector<std::int64_t> stamps;
  for (std::int64_t k = 0; k < 1000; ++k) stamps.push_back((k / 10 * 100 + k % 10) * ms);
  const Arrivals found = arrivals(stamps, 10 * ms);
  CHECK(found.late == 600);
  CHECK(found.near == 900);
  // The truth is 81 ms: nine steps less 9 ms; 5 % of the steps is allowed.
  CHECK(found.worst_late_ns == 76'500'000);
}

TEST_CASE("a loop that reads slightly slower than the device finds pairs, all reported") {
  for (const double loop_ms : {33.4, 34.0, 35.0, 40.0}) {
    CAPTURE(loop_ms);
    std::vector<std::int64_t> stamps;
    std::uint64_t pairs = 0;
    for (std::int64_t turn = 0, taken = 0; turn < 2000; ++turn) {
      const double now_ms = loop_ms * static_cast<double>(turn);
      for (int found = 0; static_cast<double>(taken) * 100.0 / 3.0 <= now_ms; ++taken, ++found) {
        stamps.push_back(std::llround(now_ms * 1e6) + found * ms / 10);
        pairs += found > 0 ? 1 : 0;
      }
    }
    const auto usual = static_cast<std::int64_t>(loop_ms * 1e6);
    CHECK(pairs > 0);
    CHECK(arrivals(stamps, usual).near == pairs);
    CHECK(arrivals(stamps, 100 * ms / 3).near == pairs);
    CHECK(arrivals(stamps, usual).late == 0);
  }
}

TEST_CASE("no sample is late: jitter, losses, pauses, another rate for a while, a rounded step") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto step =
        static_cast<std::int64_t>(5 * ms + random() % static_cast<std::uint64_t>(60 * ms));
    const auto jitter = [&] {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(step));
    };
    std::vector<std::int64_t> stamps;
    std::int64_t taken = 0;
    for (int k = 0; k < 2000; ++k) {
      const auto any = random() % 100;
      taken += any < 10 ? 2 * step : any == 10 ? 50 * step : step;
      stamps.push_back(taken + jitter());
    }
    std::sort(stamps.begin(), stamps.end());
    CHECK(arrivals(stamps, step).late == 0);
    CHECK(arrivals(stamps, step + step / 50).late == 0);
  }
  std::vector<std::int64_t> awake;  // 10 Hz, and 60 Hz for a while
  for (std::int64_t k = 0; k < 400; ++k) awake.push_back(k * 100 * ms);
  for (std::int64_t k = 1; k < 300; ++k) awake.push_back(awake[399] + k * 17 * ms);
  for (std::int64_t k = 1; k < 100; ++k) awake.push_back(awake[698] + k * 100 * ms);
  CHECK(arrivals(awake, 100 * ms).late == 0);
  CHECK(arrivals(awake, 100 * ms).near == 2);  // the beginning of the quick stretch
}

TEST_CASE("a wild stamp that is taken back leaves nothing behind") {
  for (const std::size_t from : {0, 300}) {
    CAPTURE(from);
    const auto stamps = stalled(600, 10 * ms, from, from + 40, 3 * ms);
    ArrivalSurveyor surveyor(10 * ms);
    for (std::size_t k = 0; k < stamps.size(); ++k) {
      if (k % 7 == 3) {
        surveyor.add(stamps[k] + 3'600'000 * ms);
        surveyor.take_back();
      }
      surveyor.add(stamps[k]);
    }
    CHECK(surveyor.result() == arrivals(stamps, 10 * ms));
  }
}

TEST_CASE("without a step no sample is reported") {
  CHECK(arrivals({0, 1, 2, 1000, 1001, 1002}, 0) == Arrivals{});
}
