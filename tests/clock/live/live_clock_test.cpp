// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/live_clock.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include "kinalign/clock/offline/offline_clock.h"

#include <doctest/doctest.h>
#include <malloc.h>

#include <algorithm>
#include <memory>
#include <random>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr HostTime host(Duration d) { return HostTime{1000s + d}; }
constexpr NodeTime node(Duration d) { return NodeTime{5s + d}; }

/// Ten exchanges a second, a millisecond each way, of a node without drift.
void run(LiveClock& clock, BootKey boot, Duration from, Duration until) {
  for (Duration t = from; t < until; t += 100ms) {
    clock.push_up(boot, node(t), host(t + 1ms));
    clock.push_down(boot, node(t - 50ms), host(t - 51ms));
  }
}

std::uint64_t count(const std::vector<ClockEvent>& events, ClockEvent::Kind kind) {
  return static_cast<std::uint64_t>(std::count_if(
      events.begin(), events.end(), [kind](const auto& e) { return e.kind == kind; }));
}

}  // namespace

TEST_CASE("a stamp lies in the middle of its interval, which a millisecond each way leaves") {
  LiveClock clock;
  run(clock, 7, 0s, 60s);
  const auto stamp = clock.host_from_node(7, node(60s));
  REQUIRE(stamp);
  CHECK(stamp->certainty == Certainty::certified);
  CHECK(std::chrono::abs(stamp->time - host(60s)) < 5us);
  CHECK(*stamp->earliest <= host(60s) - 999us);
  CHECK(*stamp->latest >= host(60s) + 999us);
  CHECK(*stamp->latest - *stamp->earliest < 2100us);
}

TEST_CASE("a node without frames, or without echoed replies, has no stamp") {
  LiveClock clock;
  CHECK(!clock.host_from_node(7, node(0s)));
  clock.push_up(7, node(0s), host(1ms));
  CHECK(!clock.host_from_node(7, node(0s)));
  clock.push_down(7, node(50ms), host(49ms));
  const auto stamp = clock.host_from_node(7, node(0s));
  REQUIRE(stamp);
  CHECK(stamp->certainty == Certainty::one_sided);  // one frame alone is not believed
}

TEST_CASE("a new boot begins a piece; frames of earlier boots are counted and change nothing") {
  LiveClock clock;
  run(clock, 7, 0s, 10s);
  run(clock, 8, 20s, 30s);
  CHECK(count(clock.take_events(), ClockEvent::Kind::new_boot) == 2);
  const auto before = clock.host_from_node(8, node(30s));
  clock.push_up(7, node(10s), host(30s));
  CHECK(clock.late_crossings() == 1);
  CHECK(clock.host_from_node(8, node(30s))->time == before->time);
  CHECK(!clock.host_from_node(7, node(10s)));
}

TEST_CASE("one crossing that cannot be is left out, three are a step") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  const auto before = clock.host_from_node(7, node(31s));
  clock.push_up(7, node(30s), host(29s));  // a second before it was sent
  auto events = clock.take_events();
  CHECK(count(events, ClockEvent::Kind::violator) == 0);
  CHECK(count(events, ClockEvent::Kind::host_backwards) == 1);  // the frame can't have arrived then
  LiveClock other;
  run(other, 7, 0s, 30s);
  other.push_up(7, node(31s), host(30s + 500ms));
  events = other.take_events();
  CHECK(count(events, ClockEvent::Kind::violator) == 1);
  // The host's clock may have stepped, and may step back.
  REQUIRE(count(events, ClockEvent::Kind::withdrawn) == 1);
  CHECK(events.back().begin == host(25s + 500ms));
  CHECK(events.back().end == host(30s + 500ms));
  CHECK(other.host_from_node(7, node(31s))->time == before->time);
  other.push_up(7, node(31s + 100ms), host(30s + 600ms));
  other.push_up(7, node(31s + 200ms), host(30s + 700ms));
  events = other.take_events();
  CHECK(count(events, ClockEvent::Kind::step) == 1);
  CHECK(count(events, ClockEvent::Kind::withdrawn) == 2);
  CHECK(events.back().begin < host(27s));  // five seconds before the first of them
}

TEST_CASE("fault 20 host_backwards: the piece ends") {
  LiveClock clock;
  run(clock, 7, 0s, 10s);
  static_cast<void>(clock.take_events());
  clock.push_up(7, node(10s), host(5s));
  CHECK(count(clock.take_events(), ClockEvent::Kind::host_backwards) == 1);
}

TEST_CASE("no withdrawal is lost if events are not read") {
  LiveClock clock;
  run(clock, 7, 0s, 100s);
  Duration t = 100s;
  const auto stepped = [&](Duration by) {
    for (int i = 0; i < 20; ++i, t += 100ms) {
      clock.push_up(7, node(t + by), host(t + 1ms));
      clock.push_down(7, node(t - 50ms + by), host(t - 51ms));
    }
  };
  for (int i = 1; i <= 60; ++i) stepped(1s * i);
  const auto events = clock.take_events();
  CHECK(events.size() == 64);
  REQUIRE(clock.missed_events() > 60);
  HostTime until{};
  for (const ClockEvent& event : events) {
    if (event.kind == ClockEvent::Kind::withdrawn) until = std::max(until, event.end);
  }
  CHECK(until > host(t - 6s));
}

TEST_CASE("events beyond sixty-four are counted") {
  LiveClock clock;
  for (BootKey boot = 0; boot < 100; ++boot) {
    clock.push_up(boot, node(0s), host(std::chrono::seconds(boot)));
  }
  CHECK(clock.take_events().size() == 64);
  CHECK(clock.missed_events() == 36);
  CHECK(clock.take_events().empty());
}

TEST_CASE("a clock uses at most 64 KiB, whatever a node sends") {
  const auto held = [] { return ::mallinfo2().uordblks; };
  const auto before = held();
  const auto clock = std::make_unique<LiveClock>();
  // Delays that fall and rise, so that each bound is a corner of the hulls, and in a short time of
  // the counter there are more corners than the hulls remember.
  std::size_t most = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Duration s = 400us * i, delay{(i - 10'000LL) * (i - 10'000LL) / 10};
    clock->push({7, node(s), host(s + delay + 1ms), Exchange::Echo{node(s), host(s - delay)}});
    most = std::max(most, held() - before);
  }
  if (most == 0) {
    MESSAGE("skipped: a sanitizer's heap, of which nothing is told");
    return;
  }
  CHECK(most > sizeof(LiveClock));
  CHECK(most <= 64U << 10U);
}

TEST_CASE(
    "while a crossing that cannot be is recent nothing is certified, and a reboot withdraws") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  static_cast<void>(clock.take_events());
  clock.push_up(7, node(31s), host(30s + 500ms));  // half a second before it was sent
  CHECK(clock.host_from_node(7, node(31s))->certainty == Certainty::doubtful);
  clock.push_up(8, node(0s), host(31s));
  const auto events = clock.take_events();
  CHECK(count(events, ClockEvent::Kind::withdrawn) == 2);
  for (const ClockEvent& event : events) {
    if (event.kind == ClockEvent::Kind::withdrawn) CHECK(event.begin <= host(25s + 500ms));
  }
}

TEST_CASE("a crossing that cannot be is forgotten once others exclude it") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  clock.push_up(7, node(31s), host(30s + 500ms));
  run(clock, 7, 31s, 34s);
  CHECK(clock.host_from_node(7, node(34s))->certainty == Certainty::certified);
  CHECK(count(clock.take_events(), ClockEvent::Kind::step) == 0);
}

TEST_CASE("a crossing that cannot be, and nothing excludes for five seconds, was of a step") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  // The counter steps by 2.5 ms, half a millisecond more than both delays. One frame is as fast as
  // those before, all others take ten milliseconds longer.
  const Duration step = 2500us;
  clock.push_up(7, node(31s + step), host(31s + 1ms));
  const auto slow = [&](Duration from, Duration until) {
    for (Duration t = from; t < until; t += 100ms) {
      clock.push_up(7, node(t + step), host(t + 11ms));
      clock.push_down(7, node(t - 50ms + step), host(t - 61ms));
    }
  };
  slow(31s + 100ms, 36s);
  auto events = clock.take_events();
  CHECK(count(events, ClockEvent::Kind::violator) == 1);
  CHECK(count(events, ClockEvent::Kind::step) == 0);
  CHECK(clock.host_from_node(7, node(36s))->certainty == Certainty::doubtful);
  slow(36s, 40s);
  events = clock.take_events();
  CHECK(count(events, ClockEvent::Kind::step) == 1);
  REQUIRE(count(events, ClockEvent::Kind::withdrawn) >= 1);
  const auto withdrawn = std::find_if(events.begin(), events.end(), [](const ClockEvent& e) {
    return e.kind == ClockEvent::Kind::withdrawn;
  });
  CHECK(withdrawn->begin <= host(26s + 1ms));
  const auto stamp = clock.host_from_node(7, node(40s + step));
  CHECK(stamp->certainty == Certainty::certified);
  CHECK(*stamp->earliest <= host(40s));
  CHECK(*stamp->latest >= host(40s));
}

TEST_CASE("after a contradiction that a crystal could be the cause of, the next piece allows it") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  CHECK(clock.host_from_node(7, node(30s))->assumptions == Assumptions{});
  for (Duration t = 30s; t < 34s; t += 100ms) {  // 10 us beyond both delays
    clock.push_up(7, node(t + 2010us), host(t + 1ms));
    clock.push_down(7, node(t - 50ms + 2010us), host(t - 51ms));
  }
  CHECK(count(clock.take_events(), ClockEvent::Kind::relaxed) == 1);
  const auto stamp = clock.host_from_node(7, node(34s));
  CHECK(stamp->certainty == Certainty::certified);
  CHECK(stamp->assumptions.curvature == most_curvature);

  LiveClock other;  // no crystal drifts by a second
  run(other, 7, 0s, 30s);
  for (Duration t = 30s; t < 34s; t += 100ms) other.push_up(7, node(t + 1s), host(t + 1ms));
  const auto events = other.take_events();
  CHECK(count(events, ClockEvent::Kind::step) == 1);
  CHECK(count(events, ClockEvent::Kind::relaxed) == 0);
}

TEST_CASE("the echo of the frame that shows a step is of before it, and bounds nothing behind it") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  for (Duration t = 30s; t <= 30s + 200ms; t += 100ms) {  // their replies came before: 29.95 s
    clock.push_up(7, node(t + 1s), host(t + 1ms));
    clock.push_down(7, node(29s + 950ms), host(29s + 949ms));
  }
  for (Duration t = 30s + 300ms; t < 33s; t += 100ms) {
    clock.push_up(7, node(t + 1s), host(t + 1ms));
    clock.push_down(7, node(t - 50ms + 1s), host(t - 51ms));
  }
  CHECK(count(clock.take_events(), ClockEvent::Kind::step) == 1);
  CHECK(clock.host_from_node(7, node(34s))->certainty == Certainty::certified);
}

TEST_CASE("a crystal is assumed to run as in the previous boot, to two millionths") {
  LiveClock clock;
  run(clock, 7, 0s, 60s);
  const SlopeBelief before = clock.piece()->estimate().slope();
  clock.push_up(8, node(0s), host(61s));
  const SlopeBelief after = clock.piece()->estimate().slope();
  CHECK(after.mean == before.mean);
  CHECK(after.deviation == about(before.deviation + 2e-6));
}

TEST_CASE("a step of a node that sends every five seconds is found") {
  LiveClock clock;
  for (Duration t = 0s; t < 900s; t += 5s) {
    const Duration stepped = t < 600s ? 0s : 1s;
    clock.push_up(7, node(t + stepped), host(t + 1ms));
    clock.push_down(7, node(t - 50ms + stepped), host(t - 51ms));
  }
  CHECK(count(clock.take_events(), ClockEvent::Kind::step) == 1);
  const auto stamp = clock.host_from_node(7, node(901s));
  CHECK(stamp->certainty == Certainty::certified);
  CHECK(std::chrono::abs(stamp->time - host(900s)) < 1ms);
}

TEST_CASE("a late frame of ten boots ago does not replace the present boot") {
  LiveClock clock;
  for (BootKey boot = 1; boot <= 10; ++boot) {
    const Duration begin = 10s * static_cast<int>(boot);
    clock.push_up(boot, node(0s), host(begin));
  }
  clock.push_up(1, node(1s), host(101s));
  CHECK(clock.late_crossings() == 1);
  run(clock, 10, 102s, 110s);
  CHECK(clock.late_crossings() == 1);
  CHECK(clock.host_from_node(10, node(110s)));
}

TEST_CASE("without any delay the truth lies at the interval's ends, and never outside") {
  const auto seed = fresh_seeds(1).front();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::int64_t> step(20'000'000, 100'000'000);  // ns
  LiveClock clock;
  std::vector<Exchange> exchanges;
  std::vector<Duration> truths;
  const auto counted = [](Duration t) {
    return node(std::chrono::floor<std::chrono::microseconds>(t));
  };
  Duration narrowest = 1s;
  for (Duration t = 0s; t < 60s; t += Duration{step(random)}) {
    const Duration reply = t - Duration{step(random) / 10};
    exchanges.push_back({7, counted(t), host(t), Exchange::Echo{counted(reply), host(reply)}});
    truths.push_back(t);
    clock.push(exchanges.back());
    const auto stamp = clock.host_from_node(7, counted(t));
    if (!stamp || stamp->certainty != Certainty::certified) continue;
    CHECK(*stamp->earliest <= host(t));
    CHECK(*stamp->latest >= host(t));
    narrowest = std::min(narrowest, *stamp->latest - *stamp->earliest);
  }
  CHECK(narrowest < 3us);  // small enough that an error of a microsecond would show
  const auto offline = fit_offline_clock(exchanges);
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    const auto stamp = host_from_node(offline.model, 7, exchanges[i].n_tx, exchanges[i].h_rx);
    REQUIRE(stamp);
    CHECK(stamp->certainty == Certainty::certified);
    CHECK(*stamp->earliest <= host(truths[i]));
    CHECK(*stamp->latest >= host(truths[i]));
  }
}

TEST_CASE("the first packet that takes no time, of a clock at the greatest rate, is no violator") {
  for (const int ppm : {95, -95}) {
    for (const bool up : {true, false}) {  // the direction in which all earlier packets took ten
      CAPTURE(ppm);
      CAPTURE(up);
      const auto counted = [ppm](Duration h) {
        return node(std::chrono::floor<std::chrono::microseconds>(h + h / 1'000'000 * ppm));
      };
      LiveClock clock;
      for (int i = 0; i < 200; ++i) {
        const Duration t = 70ms * i, late = i % 50 == 49 ? 0ms : 10ms;
        clock.push_up(7, counted(t), host(t + (up ? late : 0ms)));
        clock.push_down(7, counted(t - 10ms), host(t - 10ms - (up ? 0ms : late)));
      }
      CHECK(count(clock.take_events(), ClockEvent::Kind::violator) == 0);
    }
  }
}

TEST_CASE("after a second step within five seconds it takes five without one") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  const auto stepped = [&](Duration by, Duration from, Duration until) {
    for (Duration t = from; t < until; t += 100ms) {
      clock.push_up(7, node(t + by), host(t + 1ms));
      clock.push_down(7, node(t - 50ms + by), host(t - 51ms));
    }
  };
  const auto certainty = [&](Duration t) { return clock.host_from_node(7, node(t))->certainty; };
  stepped(1s, 30s, 32s);
  CHECK(certainty(33s) == Certainty::certified);
  stepped(2s, 32s, 37s);
  CHECK(certainty(39s) == Certainty::doubtful);
  stepped(2s, 37s, 38s);
  CHECK(certainty(40s) == Certainty::certified);
}

TEST_CASE("fault 20 host_backwards: nothing is left of a step, nor certified before it") {
  LiveClock clock;
  run(clock, 7, 0s, 30s);
  clock.push_up(7, node(31s), host(30s + 500ms));  // half a second before it was sent
  clock.push_up(7, node(1s), host(-500s));
  const auto events = clock.take_events();
  // The violator's interval and the time up to then.
  CHECK(count(events, ClockEvent::Kind::withdrawn) == 2);
  CHECK(count(events, ClockEvent::Kind::host_backwards) == 1);

  LiveClock other;
  run(other, 7, 0s, 30s);
  for (Duration t = 30s; t < 30s + 500ms; t += 100ms) other.push_up(7, node(t + 1s), host(t + 1ms));
  run(other, 7, -500s, -495s);
  CHECK(other.host_from_node(7, node(-495s))->certainty == Certainty::certified);
}

TEST_CASE("after a reboot it is known how narrow an interval can be") {
  LiveClock clock;
  run(clock, 7, 0s, 60s);
  const double least = clock.piece()->floors().shortest().least_width();
  CHECK(least == about(0.8 * 2e-3, 0.1));
  run(clock, 8, 61s, 62s);
  CHECK(clock.piece()->floors().shortest().least_width() == least);
}
