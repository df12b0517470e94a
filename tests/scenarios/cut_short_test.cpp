// SPDX-License-Identifier: Apache-2.0
// Steps and sleeps of the counter that are cut short by a reboot or by the end. Also readings from
// before a step that are asked for after it, like samples that waited in the node.
#include "tests/scenarios/minutes.h"
#include "tests/seeds.h"
#include "tools/clock_table/judge.h"

#include "kinalign/simulate/nodes/node_clock.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

using namespace kinalign;

namespace {

/// The reading of the node's counter at host time t (s): it steps once.
NodeTime reading(const SimulatedClock& clock, const CounterStep& step, double t) {
  const double s = clock.reading(t) + (t >= step.at ? step.by : 0.0);
  return counter_time(static_cast<std::int64_t>(s * 1e6));
}

bool wrong(const std::optional<ClockStamp>& stamp, double t) {
  if (!stamp || stamp->certainty != Certainty::certified) return false;
  return *stamp->earliest > arrival_time(t + 1e-6) || *stamp->latest < departure_time(t - 1e-6);
}

/// The live stamp of a sample, given when its frame arrived.
struct Given {
  HostTime arrival{};
  bool wrong = false, withdrawn = false;
};

void withdraw(const std::vector<ClockEvent>& events, std::vector<Given>& all) {
  for (const ClockEvent& event : events) {
    if (event.kind != ClockEvent::Kind::withdrawn) continue;
    for (Given& given : all) {
      given.withdrawn |= event.begin <= given.arrival && given.arrival <= event.end;
    }
  }
}

}  // namespace

TEST_CASE("fault 36 sample_batch: readings of before a step are not certified behind it") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    for (const double by : {0.02, -0.02, 30.0, -30.0}) {
      CAPTURE(by);
      ExchangeOptions options = minutes(Link::quiet, 1.0);
      options.steps = {{.at = 30.0, .by = by}};
      const SimulatedExchanges simulated = simulate_exchanges(options, seed);
      const std::vector<Exchange> exchanges = exchanges_of(simulated);
      const SimulatedClock counter(seed, options.length_s);
      const OfflineClock offline = fit_offline_clock(exchanges);
      LiveClock live;
      std::vector<Given> given;
      std::size_t certified = 0;
      for (const Exchange& e : exchanges) {
        live.push(e);
        for (const double age : {0.0, 0.3, 1.5, 3.0, 8.0}) {
          const double t = seconds_of(e.h_rx) - 0.05 - age;  // its frame is sent within that time
          if (t < 1.0) continue;
          const NodeTime n = reading(counter, options.steps[0], t);
          const auto stamp = live.host_from_node(e.boot, n);
          certified += stamp && stamp->certainty == Certainty::certified ? 1 : 0;
          given.push_back({e.h_rx, wrong(stamp, t)});
          CHECK(!wrong(host_from_node(offline.model, e.boot, n, e.h_rx), t));
        }
        withdraw(live.take_events(), given);
      }
      for (const Given& stamp : given) CHECK((!stamp.wrong || stamp.withdrawn));
      CHECK(certified > given.size() / 2);
    }
  }
}

TEST_CASE("fault 7 light_sleep: cut short by a reboot or the end it leaves no wrong stamp on A") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    for (const double slept : {4.0, 10.0}) {
      for (const double rate : {500e-6, -500e-6}) {
        for (const bool reboots : {true, false}) {
          CAPTURE(slept);
          CAPTURE(rate);
          CAPTURE(reboots);
          ExchangeOptions options = minutes(Link::wired, 1.0);
          options.stretches = {{.begin = 40.0 - slept, .end = 40.0, .rate = rate}};
          if (reboots) options.reboots = {{.at = 40.0, .gap = 0.3}};
          options.length_s = reboots ? 50.0 : 40.0;
          const SimulatedExchanges exchanges = simulate_exchanges(options, seed);
          CHECK(judge_live(exchanges).lies() == 0);
          CHECK(judge_offline(exchanges).lies() == 0);
        }
      }
    }
  }
}

TEST_CASE("a step is in doubt for a second, and for five where a clock that bends shows the same") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    for (const bool bends : {false, true}) {
      CAPTURE(bends);
      ExchangeOptions options = minutes(Link::wired, 1.0);
      if (!bends) options.steps = {{.at = 30.0, .by = 0.05}};
      if (bends) options.clock = {.frequency_error = 0.0, .temperature = false, .ramp = 1e-6};
      const JudgedRun run = judge_live(simulate_exchanges(options, seed));
      CHECK(run.lies() == 0);
      CHECK(run.count(ClockEvent::Kind::relaxed) == (bends ? 1 : 0));
      REQUIRE(run.count(ClockEvent::Kind::step) == 1);
      REQUIRE(run.count(ClockEvent::Kind::settled) == 1);
      double took = 0.0;
      for (const ClockEvent& event : run.events) {
        if (event.kind == ClockEvent::Kind::step) took -= seconds_of(event.end);
        if (event.kind == ClockEvent::Kind::settled) took += seconds_of(event.end);
      }
      CHECK(took >= (bends ? 5.0 : 1.0));
      CHECK(took < (bends ? 5.3 : 1.3));
    }
  }
}
