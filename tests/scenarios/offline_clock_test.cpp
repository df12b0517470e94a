// SPDX-License-Identifier: Apache-2.0
// The offline clock over simulated links, on fresh seeds each time.
#include "tests/scenarios/minutes.h"
#include "tests/seeds.h"
#include "tools/clock_table/judge.h"

#include "kinalign/clock/assumptions.h"
#include "kinalign/clock/live/violators.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

using namespace kinalign;

namespace {

/// Whether a frame after a step forward arrived too early to fit a reply before the step. If none
/// did, the host got nothing that a counter without a step would not have sent.
bool is_seen(const std::vector<Exchange>& received, double step_at) {
  for (const Exchange& behind : received) {
    if (seconds_of(behind.h_rx) < step_at || behind.boot != received.front().boot) continue;
    for (const Exchange& e : received) {
      if (!e.echo || seconds_of(e.h_rx) > step_at) continue;
      const Duration host = behind.h_rx - e.echo->h_tx, node = behind.n_tx - e.echo->n_rx;
      if (seconds(node - host) > greatest_rate * seconds(node) + Violators::tolerated_s)
        return true;
    }
  }
  return false;
}

}  // namespace

// live_clock_test.cpp does the same: the bars themselves are judged on seeds that stay the same.
TEST_CASE("offline errors stay within one and a half times the bars of each link, on any seeds") {
  struct Bar {
    Link link;
    double pooled_ms, each_ms, worst_ms, net_ms;
  };
  // Promise 2, offline at 60 s, for 20 seeds; net: without (Fu - Fd) / 2, which no exchange can
  // show.
  constexpr std::array bars{
      Bar{Link::wired, 0.005, 0.008, 0.012, 0.001}, Bar{Link::quiet, 0.080, 0.12, 0.13, 0.002},
      Bar{Link::paper, 0.10, 0.25, 0.45, 0.06},     Bar{Link::modem_sleep, 0.085, 0.15, 0.20, 0.02},
      Bar{Link::congested, 0.28, 0.38, 0.45, 0.05}, Bar{Link::roaming, 0.15, 0.50, 1.0, 0.15},
      Bar{Link::thin_floor, 0.75, 2.5, 4.5, 0.75}};
  constexpr double tolerated = 1.5 * ms;
  const auto seeds = fresh_seeds(40);
  for (const Bar& bar : bars) {
    CAPTURE(letter(bar.link));
    std::vector<double> total, net;
    int over = 0;
    for (const auto seed : seeds) {
      CAPTURE(seed);
      const auto run = judge_offline(simulate_exchanges(minutes(bar.link, 1.0), seed));
      CHECK(run.lies() == 0);
      CHECK(run.stamps.size() == run.frames);
      const auto errors = errors_since(run, 0.0), less = errors_since(run, 0.0, run.asymmetry);
      const ErrorFigures found = figures(errors);
      over += found.rms > bar.each_ms * tolerated || found.worst > bar.worst_ms * tolerated ? 1 : 0;
      total.insert(total.end(), errors.begin(), errors.end());
      net.insert(net.end(), less.begin(), less.end());
    }
    CHECK(over <= 1);
    CHECK(figures(total).rms < bar.pooled_ms * tolerated);
    CHECK(figures(net).rms < bar.net_ms * tolerated);
  }
}

TEST_CASE("over ten minutes of roaming the offset is carried from route to route") {
  for (const auto seed : fresh_seeds(3)) {
    CAPTURE(seed);
    const auto run = judge_offline(simulate_exchanges(minutes(Link::roaming, 10.0), seed));
    CHECK(run.lies() == 0);
    CHECK(figures(errors_since(run, 0.0)).rms < 1.6 * ms);
  }
}

TEST_CASE("pieces are those of the node's boots and steps, and no kept stamp is wrong") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    ExchangeOptions options = minutes(Link::paper, 1.0);
    options.reboots = {{.at = 20.0, .gap = 1.0}};
    options.steps = {{.at = 40.0, .by = -1.0}};
    const SimulatedExchanges exchanges = simulate_exchanges(options, seed);
    const OfflineClock clock = fit_offline_clock(exchanges_of(exchanges));
    CHECK(clock.model.pieces.size() == 4);  // one of them is the second after the step
    const JudgedRun run = judge_offline(exchanges);
    CHECK(run.lies() == 0);
    CHECK(figures(errors_since(run, 42.0)).worst < 2.0 * ms);
  }
}

TEST_CASE(
    "fault 4 counter_step_fwd, counter_step_back: what a reboot or the end cuts short leaves no "
    "wrong stamp") {
  int seen = 0, all = 0;
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    for (const double cut : {0.5, 2.0, 4.0}) {  // s after the step
      for (const bool reboots : {true, false}) {
        CAPTURE(cut);
        CAPTURE(reboots);
        ExchangeOptions options = minutes(Link::quiet, 1.0);
        options.rate_hz = 5.0;
        const Floors least = floors(options.link.link, seed);
        options.steps = {{.at = 40.0, .by = 1.5 * (least.up + least.down)}};
        if (reboots) options.reboots = {{.at = 40.0 + cut, .gap = 1.0}};
        if (!reboots) options.length_s = 40.0 + cut;
        const SimulatedExchanges exchanges = simulate_exchanges(options, seed);
        ++all;
        if (!is_seen(exchanges_of(exchanges), 40.0)) continue;
        ++seen;
        CHECK(judge_offline(exchanges).lies() == 0);
      }
    }
  }
  CHECK(2 * seen > all);
}

TEST_CASE("packets that find a shorter route do not look like a step") {
  std::uint64_t needless = 0;
  for (const auto seed : fresh_seeds(10)) {
    for (const Link link : {Link::quiet, Link::paper, Link::modem_sleep}) {
      CAPTURE(seed);
      CAPTURE(letter(link));
      ExchangeOptions options = minutes(link, 4.0);
      options.link.faults = {{.begin = 0.0, .end = 183.0, .extra_up = 5.0 * ms}};
      const SimulatedExchanges exchanges = simulate_exchanges(options, seed);
      const JudgedRun live = judge_live(exchanges);
      needless += live.count(ClockEvent::Kind::slip) + live.count(ClockEvent::Kind::step);
      CHECK(live.lies() + judge_offline(exchanges).lies() == 0);
    }
  }
  CHECK(needless <= 1);  // one in 4000 runs is such a case
}

TEST_CASE("a clock that bends more than assumed is certified once that has shown") {
  for (const auto seed : fresh_seeds(5)) {
    CAPTURE(seed);
    ExchangeOptions options = minutes(Link::wired, 1.0);
    options.clock = {.frequency_error = 0.0, .temperature = false, .ramp = 1e-6};
    const SimulatedExchanges exchanges = simulate_exchanges(options, seed);
    const auto clock = fit_offline_clock(exchanges_of(exchanges));
    CHECK(!clock.model.pieces.front().certified);
    CHECK(clock.model.pieces.back().certified);
    CHECK(clock.model.pieces.back().assumptions.curvature == most_curvature);
    const JudgedRun run = judge_offline(exchanges);
    CHECK(run.lies() == 0);
    CHECK(run.stamps.size() == run.frames);  // a doubtful frame has a likeliest stamp, too
  }
}

TEST_CASE("after a detected step an offline stamp is certified a second later") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    ExchangeOptions options = minutes(Link::wired, 1.0);
    options.steps = {{.at = 30.0, .by = 1.0}};
    const JudgedRun run = judge_offline(simulate_exchanges(options, seed));
    CHECK(run.lies() == 0);
    for (const JudgedStamp& stamp : run.stamps) {
      if (stamp.sent > 32.0) CHECK(stamp.certified);
    }
  }
}

TEST_CASE("a stretch of doubt within a longer one does not end that") {
  using namespace std::chrono_literals;
  std::vector<Exchange> exchanges;
  for (Duration t = 0s; t < 90s; t += 100ms) {
    // Less than both delays: the floors show the step.
    const Duration stepped = t < 65s ? 0s : 1500us;
    const Duration lie = t == 66s ? 1s : 0s;
    exchanges.push_back({1, NodeTime{t + stepped + lie}, HostTime{t + 1ms},
                         Exchange::Echo{NodeTime{t + stepped - 50ms}, HostTime{t - 51ms}}});
  }
  const OfflineClock clock = fit_offline_clock(exchanges);
  const auto count = [&](ClockEvent::Kind kind) {
    return std::count_if(clock.events.begin(), clock.events.end(),
                         [kind](const ClockEvent& event) { return event.kind == kind; });
  };
  CHECK(count(ClockEvent::Kind::violator) == 1);
  CHECK(count(ClockEvent::Kind::slip) == 1);
  for (const Duration t : {62s, 68s, 73s}) {
    CAPTURE(t.count());
    CHECK(is_in(clock.model.doubtful, HostTime{t}));
  }
}

TEST_CASE("a boot of one frame, and one without a reply, are pieces without certificates") {
  using namespace std::chrono_literals;
  const std::vector<Exchange> exchanges{
      {1, NodeTime{5s}, HostTime{10s}, std::nullopt},
      {2, NodeTime{5s}, HostTime{11s}, std::nullopt},
      {2, NodeTime{6s}, HostTime{12s}, Exchange::Echo{NodeTime{5500ms}, HostTime{11500ms}}},
      {3, NodeTime{5s}, HostTime{13s}, std::nullopt}};
  const auto clock = fit_offline_clock(exchanges);
  REQUIRE(clock.model.pieces.size() == 3);
  CHECK(clock.model.pieces[2].assumptions == Assumptions{});
  CHECK(!host_from_node(clock.model, 1, NodeTime{5s}, HostTime{10s}));
  CHECK(host_from_node(clock.model, 2, NodeTime{5s}, HostTime{11s}));
  CHECK(fit_offline_clock({}).model.pieces.empty());
}

TEST_CASE("a counter that runs a day in a second of the host gets no certificate") {
  using namespace std::chrono_literals;
  for (const Duration counted : {Duration(1s), Duration(24h)}) {
    CAPTURE(counted.count());
    const NodeTime begin{5s}, end = begin + counted;
    const std::vector<Exchange> exchanges{
        {1, begin, HostTime{11s}, std::nullopt},
        {1, end, HostTime{12s}, Exchange::Echo{end - 500ms, HostTime{11500ms}}}};
    const auto clock = fit_offline_clock(exchanges);
    REQUIRE(clock.model.pieces.size() == 1);
    const ClockPieceModel& piece = clock.model.pieces[0];
    const bool like_the_host = counted == 1s;
    CHECK(piece.certified == like_the_host);
    CHECK(piece.knots.empty() != like_the_host);
    CHECK(host_from_node(clock.model, 1, begin, HostTime{11s}).has_value() == like_the_host);
  }
}

TEST_CASE("a frame of the previous boot after the first of the next one harms neither") {
  for (const auto seed : fresh_seeds(5)) {
    CAPTURE(seed);
    ExchangeOptions options = minutes(Link::quiet, 1.0);
    options.reboots = {{.at = 30.0, .gap = 1.0}};
    auto exchanges = exchanges_of(simulate_exchanges(options, seed));
    const auto second = std::find_if(exchanges.begin(), exchanges.end(), [&](const Exchange& e) {
      return e.boot != exchanges.front().boot;
    });
    REQUIRE(second != exchanges.end());
    const Exchange last = *(second - 1);
    Exchange late = last;
    late.h_rx = (second + 3)->h_rx;
    const auto clean = fit_offline_clock(exchanges);
    exchanges.insert(second + 4, late);
    const auto clock = fit_offline_clock(exchanges);
    REQUIRE(clock.model.pieces.size() == 2);
    for (const Exchange& e : exchanges) {
      if (e.h_rx == late.h_rx && e.boot == late.boot) continue;
      const auto stamp = host_from_node(clock.model, e.boot, e.n_tx, e.h_rx);
      const auto other = host_from_node(clean.model, e.boot, e.n_tx, e.h_rx);
      REQUIRE(stamp);
      REQUIRE(other);
      CHECK(stamp->certainty == Certainty::certified);
      CHECK(stamp->time == other->time);
    }
    CHECK(!host_from_node(clock.model, late.boot, late.n_tx, late.h_rx));
  }
}
