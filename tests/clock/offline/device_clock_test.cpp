// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/device_clock.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr Duration utc_minus_host = 1'700'000'000s;

/// Fifteen frames a second with their answers, 1.5 to 6 ms each way; the counter runs 30 ppm slow.
struct Node {
  std::mt19937_64 random{7};
  std::vector<Exchange> exchanges;
  std::vector<HostTime> sent;  // the truth

  Duration way() {
    return Duration{std::uniform_int_distribution<std::int64_t>(1'500'000, 6'000'000)(random)};
  }
  void live(BootKey boot, HostTime booted, Duration from, Duration to, bool answered) {
    const auto n_at = [&](HostTime h) {
      return NodeTime{Duration{
          1000 * (std::llround(static_cast<double>((h - booted).count()) * (1.0 - 30e-6)) / 1000)}};
    };
    std::optional<Exchange::Echo> echo;
    for (Duration t = from; t < to; t += Duration{1s} / 15) {
      const HostTime at = booted + t, arrival = at + way();
      exchanges.push_back({boot, n_at(at), arrival, echo});
      sent.push_back(at);
      if (answered) echo = {n_at(arrival + 100us + way()), arrival + 100us};
    }
  }
};

std::size_t first_of(const Node& node, BootKey boot) {
  std::size_t i = 0;
  while (node.exchanges.at(i).boot != boot) ++i;
  return i;
}

struct Told {
  Time stamp;
  Duration error;
  std::optional<Duration> half_width;
};

std::vector<Told> tell(const DeviceClock& clock, const Node& node) {
  std::vector<Told> out;
  for (std::size_t i = 0; i < node.exchanges.size(); ++i) {
    const Exchange& e = node.exchanges[i];
    const auto stamp = stamp_of(clock, e.boot, e.n_tx, e.h_rx);
    REQUIRE(stamp);
    const Time truth{node.sent[i].time_since_epoch() + utc_minus_host};
    out.push_back({*stamp, take_time(clock.time, *stamp) - truth, half_width(clock.time, *stamp)});
  }
  return out;
}

}  // namespace

TEST_CASE("a node's stamps are its counter's readings, its model holds the truth in its interval") {
  Node node;
  node.live(1, HostTime{50s}, 10s, 70s, true);
  const DeviceClock clock = device_clock(node.exchanges, utc_minus_host);
  const auto told = tell(clock, node);
  for (std::size_t i = 0; i < told.size(); ++i) {
    CHECK(told[i].stamp == Time{node.exchanges[i].n_tx.time_since_epoch()});
    REQUIRE(told[i].half_width);
    CHECK(std::abs(told[i].error.count()) <= told[i].half_width->count());
    CHECK(*told[i].half_width < 3ms);
    CHECK(std::abs(told[i].error.count()) < 300'000);
  }
}

TEST_CASE("after a restart stamps continue to rise, by the host's time, and stay true") {
  Node node;
  node.live(1, HostTime{50s}, 10s, 40s, true);
  node.live(2, HostTime{95s}, 1s, 31s, true);
  const DeviceClock clock = device_clock(node.exchanges, utc_minus_host);
  const auto told = tell(clock, node);
  for (std::size_t i = 1; i < told.size(); ++i) {
    CHECK(told[i].stamp > told[i - 1].stamp);
    CHECK(std::abs(told[i].error.count()) < 500'000);
    REQUIRE(told[i].half_width);
    CHECK(std::abs(told[i].error.count()) <= told[i].half_width->count());
  }
  CHECK(clock.moved.front() == 0s);
  // A sample half a second older than the first frame of the second life gets its stamp from that
  // life's clock.
  const std::size_t begin = first_of(node, 2);
  const Exchange& first = node.exchanges[begin];
  const auto older = stamp_of(clock, 2, first.n_tx - 500ms, first.h_rx);
  const Time truth{node.sent[begin].time_since_epoch() + utc_minus_host - 500ms};
  CHECK(std::abs((take_time(clock.time, *older) - truth).count()) < 500'000);
}

TEST_CASE("a boot without replies gets a clock from its arrivals, and no interval") {
  Node node;
  node.live(1, HostTime{50s}, 10s, 40s, true);
  node.live(2, HostTime{95s}, 1s, 31s, false);
  const auto told = tell(device_clock(node.exchanges, utc_minus_host), node);
  for (std::size_t i = first_of(node, 2); i < told.size(); ++i) {
    CHECK(!told[i].half_width);
    CHECK(told[i].error > 1ms);  // late by the fastest delay, 1.5 ms
    CHECK(told[i].error < 2ms);
  }
  REQUIRE(told.front().half_width);
}

TEST_CASE("boots without frames have no stamps, and no exchange gives no clock") {
  Node node;
  node.live(1, HostTime{50s}, 10s, 12s, true);
  const DeviceClock clock = device_clock(node.exchanges, utc_minus_host);
  CHECK(!stamp_of(clock, 2, NodeTime{1s}, HostTime{61s}));
  // Held until the node was accepted.
  CHECK(stamp_of(clock, 1, NodeTime{9s}, HostTime{59s}) == Time{9s});
  const DeviceClock none = device_clock({}, utc_minus_host);
  CHECK(!stamp_of(none, 1, NodeTime{1s}, HostTime{61s}));
  CHECK(take_time(none.time, Time{5s}) == Time{5s});
  CHECK(!half_width(none.time, Time{5s}));
}
