// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/one_way_clock.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr Duration least_way = 2ms;

/// A device that counts 40 ppm fast, 60 times a second; ways of 2 ms and more, half of them by more
/// than 7 ms.
struct Device {
  std::mt19937_64 random{20261123};
  std::vector<Exchange> exchanges;
  std::vector<HostTime> sent;  // the truth

  void send(BootKey boot, NodeTime n, HostTime at, Duration held = 0ms) {
    std::exponential_distribution<double> more(1.0 / 0.007);
    const Duration way = least_way + Duration{std::llround(1e9 * more(random))};
    const HostTime arrival = std::max(at + std::max(way, held), newest);
    exchanges.push_back({boot, n, arrival, std::nullopt});
    sent.push_back(at);
    newest = arrival;
  }
  HostTime newest = HostTime::min();
};

NodeTime counter(Duration since_start) {
  return NodeTime{7s + Duration{std::llround(1.00004 * static_cast<double>(since_start.count()))}};
}

/// Smallest and largest lateness of the stamps against the truth.
struct Lateness {
  Duration least = 1h, most = -1h;
};

Lateness lateness(const HostFromNode& model, const Device& device, std::size_t from,
                  std::size_t to) {
  Lateness out;
  for (std::size_t i = from; i < to; ++i) {
    const Exchange& e = device.exchanges[i];
    const auto stamp = host_from_node(model, e.boot, e.n_tx, e.h_rx);
    REQUIRE(stamp);
    CHECK(stamp->certainty == Certainty::one_sided);
    out.least = std::min(out.least, stamp->time - device.sent[i]);
    out.most = std::max(out.most, stamp->time - device.sent[i]);
  }
  return out;
}

}  // namespace

TEST_CASE(
    "stamps of a device that nothing answers are late by its fastest packets, from end to end") {
  Device device;
  for (int k = 0; k < 3600; ++k) {
    const Duration t = k * Duration{1s} / 60;
    device.send(1, counter(t), HostTime{100s + t});
  }
  const HostFromNode model = fit_one_way_clock(device.exchanges);
  REQUIRE(model.pieces.size() == 1);
  CHECK(!model.pieces[0].certified);
  const Lateness all = lateness(model, device, 0, device.exchanges.size());
  CHECK(all.least > least_way - 200us);
  CHECK(all.most < least_way + 500us);
}

TEST_CASE("a device that pauses its counter for five seconds begins a piece there") {
  Device device;
  for (int k = 0; k < 3600; ++k) {
    const Duration t = k * Duration{1s} / 60, paused = k < 1800 ? 0s : 5s;
    device.send(1, counter(t), HostTime{100s + t + paused});
  }
  const HostFromNode model = fit_one_way_clock(device.exchanges);
  REQUIRE(model.pieces.size() == 2);
  const Lateness before = lateness(model, device, 0, 1800),
                 behind = lateness(model, device, 1800, 3600);
  CHECK(before.most < least_way + 500us);
  CHECK(behind.least > least_way - 500us);
  CHECK(behind.most < least_way + 500us);
}

TEST_CASE("packets that a radio holds back for two seconds do not move the clock") {
  Device device;
  for (int k = 0; k < 1800; ++k) {
    const Duration t = k * Duration{1s} / 60;
    const Duration held = t >= 10s && t < 12s ? 12s - t : 0ms;
    device.send(1, counter(t), HostTime{100s + t}, held);
  }
  const HostFromNode model = fit_one_way_clock(device.exchanges);
  CHECK(model.pieces.size() == 1);
  CHECK(lateness(model, device, 0, device.exchanges.size()).most < least_way + 500us);
}

TEST_CASE("each boot has a piece, also with a single packet; no packets give no piece") {
  CHECK(fit_one_way_clock({}).pieces.empty());
  Device device;
  device.send(1, NodeTime{5s}, HostTime{100s});
  for (int k = 0; k < 60; ++k)
    device.send(2, NodeTime{k * Duration{1s} / 60}, HostTime{110s + k * Duration{1s} / 60});
  const HostFromNode model = fit_one_way_clock(device.exchanges);
  REQUIRE(model.pieces.size() == 2);
  CHECK(host_from_node(model, 1, NodeTime{5s}, device.exchanges[0].h_rx)->time ==
        device.exchanges[0].h_rx + 500ns);
  CHECK(model.pieces[1].boot == 2);
}

TEST_CASE(
    "a device that speaks seldom costs memory by what it said, not by how long it was silent") {
  const auto year = 365 * 24h;
  const std::vector<Exchange> exchanges{{1, NodeTime{0s}, HostTime{1s}, {}},
                                        {1, NodeTime{20 * year}, HostTime{20 * year + 1s}, {}}};
  const HostFromNode model = fit_one_way_clock(exchanges);
  std::size_t knots = 0;
  for (const ClockPieceModel& piece : model.pieces) knots += piece.knots.size();
  CHECK(knots < 10);
}
