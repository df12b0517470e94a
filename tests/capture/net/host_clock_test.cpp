// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/net/host_clock.h"

#include <doctest/doctest.h>

#include <random>
#include <utility>

namespace kinalign {

namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using Kind = HostClockEvent::Kind;

/// Clocks that stand still until the test moves them; reading one takes 100 ns.
struct FakeClocks : ClockReader {
  HostTime raw() override { return raw_now += Duration{50}; }
  Time utc() override { return utc_now + Duration{50}; }
  Duration asleep() override { return slept; }
  bool wall_was_set() override { return std::exchange(was_set, false); }
  void pass(Duration d, double wall_rate = 1.0) {
    raw_now += d;
    utc_now += Duration{static_cast<std::int64_t>(static_cast<double>(d.count()) * wall_rate)};
  }
  HostTime raw_now{hours(10)};
  Time utc_now = utc_time(1'700'000'000'000'000'000);
  Duration slept{0};
  bool was_set = false;
};

std::vector<Kind> kinds(HostAxis& axis) {
  std::vector<Kind> all;
  for (const HostClockEvent& event : axis.take_events()) all.push_back(event.kind);
  return all;
}

}  // namespace

TEST_CASE("an arrival is never moved to before it was, and by little behind it") {
  std::mt19937 random(1);
  FakeClocks clocks;
  HostAxis axis(clocks);
  for (int i = 0; i < 1000; ++i) {
    const double slew =
        (static_cast<double>(random() % 1001) - 500) * 1e-6;  // the kernel slews by 500 ppm at most
    clocks.pass(microseconds(random() % 60'000), 1 + slew);
    const HostTime truth = clocks.raw_now;
    const Time stamp = clocks.utc_now;
    const Duration waits = microseconds(random() % 2000);
    clocks.pass(waits, 1 + slew);
    axis.look();
    const HostTime found = axis.arrival(stamp);
    REQUIRE(found >= truth);
    REQUIRE(found - truth < microseconds(1) + waits / 500);
  }
}

TEST_CASE("without a stamp, or one from the future, an arrival is now") {
  FakeClocks clocks;
  HostAxis axis(clocks);
  axis.look();
  CHECK(axis.arrival(std::nullopt) <= clocks.raw_now);
  CHECK(axis.arrival(std::nullopt) > clocks.raw_now - microseconds(1));
  CHECK(axis.arrival(clocks.utc_now + hours(1)) == axis.arrival(std::nullopt));
}

TEST_CASE("fault 17 host_step: a step of the wall clock moves no stamp, and is reported") {
  for (const Duration step : {Duration(hours(1)), -Duration(hours(1)), Duration(milliseconds(5))}) {
    FakeClocks clocks;
    HostAxis axis(clocks);
    axis.watch();
    clocks.pass(milliseconds(100));
    const HostTime truth = clocks.raw_now;
    const Time stamp = clocks.utc_now;
    clocks.utc_now += step;
    clocks.was_set = true;
    clocks.pass(microseconds(30));
    axis.look();
    CHECK(axis.arrival(stamp) >= truth);
    CHECK(axis.arrival(stamp) - truth < microseconds(40));
    for (int batch = 0; batch < 3; ++batch) {  // other datagrams were received first
      clocks.pass(microseconds(30));
      axis.look();
      CHECK(axis.arrival(stamp) >= truth);
    }
    axis.watch();
    const auto events = axis.take_events();
    REQUIRE(events.size() == 1);
    CHECK(events[0].kind == Kind::wall_stepped);
    CHECK(std::abs(seconds(events[0].by - step)) < 1e-6);
    clocks.pass(milliseconds(100));
    axis.look();
    CHECK(axis.epoch() == 0);
    axis.watch();
    CHECK(axis.take_events().empty());
  }
}

TEST_CASE("a step too small to distinguish from a slew moves no stamp: the system reports it") {
  for (const auto& [step, watched] :
       {std::pair{microseconds(40), false}, std::pair{microseconds(-40), false},
        std::pair{microseconds(40), true}}) {
    FakeClocks clocks;
    HostAxis axis(clocks);
    clocks.pass(milliseconds(100));
    const HostTime truth = clocks.raw_now;
    const Time stamp = clocks.utc_now;
    clocks.utc_now += step;
    clocks.was_set = true;
    if (watched) axis.watch();  // asks first
    for (int batch = 0; batch < 3; ++batch) {
      clocks.pass(microseconds(30));
      axis.look();
      CHECK(axis.arrival(stamp) >= truth);
      CHECK(axis.arrival(stamp) - truth < microseconds(140));
    }
  }
}

TEST_CASE("fault 18 host_slew: it moves no stamp and is no step") {
  struct Slew {
    double rate;
    int seconds;
    Duration moved;  // at most, of an arrival that waited for 50 us
  };
  for (const Slew& slew : {Slew{500e-6, 3600, microseconds(1)},   // the kernel's own
                           Slew{0.083, 60, microseconds(60)}}) {  // chronyd's fastest
    CAPTURE(slew.rate);
    FakeClocks clocks;
    HostAxis axis(clocks);
    for (int s = 0; s < slew.seconds; ++s) {
      clocks.pass(std::chrono::seconds(1), 1 + slew.rate);
      const HostTime truth = clocks.raw_now;
      const Time stamp = clocks.utc_now;
      clocks.pass(microseconds(50), 1 + slew.rate);
      axis.look();
      REQUIRE(axis.arrival(stamp) >= truth);
      REQUIRE(axis.arrival(stamp) - truth < slew.moved);
      axis.watch();
    }
    CHECK(axis.take_events().empty());
  }
}

TEST_CASE("fault 19 host_suspend: a sleep ends the epoch") {
  FakeClocks clocks;
  HostAxis axis(clocks);
  axis.watch();
  clocks.pass(std::chrono::seconds(1));
  clocks.slept = std::chrono::seconds(30);
  clocks.utc_now += std::chrono::seconds(30);
  axis.watch();
  CHECK(kinds(axis) == std::vector{Kind::suspended, Kind::wall_stepped});
  CHECK(axis.epoch() == 1);
  axis.watch();
  CHECK(axis.epoch() == 1);
}

TEST_CASE("fault 20 host_backwards: the axis stands still for a moment and goes on") {
  FakeClocks clocks;
  HostAxis axis(clocks);
  const HostTime before = axis.now();
  clocks.raw_now -= std::chrono::seconds(5);
  const HostTime at = axis.now();
  CHECK(at >= before);
  clocks.pass(std::chrono::seconds(1));
  CHECK(std::abs(seconds(axis.now() - at) - 1.0) < 1e-6);
  CHECK(axis.epoch() == 1);
  CHECK(kinds(axis) == std::vector{Kind::backwards});
}

TEST_CASE("up to 64 unread events are kept, the others are counted") {
  FakeClocks clocks;
  HostAxis axis(clocks);
  axis.watch();
  for (int i = 0; i < 70; ++i) {
    clocks.utc_now += hours(i);
    clocks.was_set = true;
    axis.watch();
  }
  const auto events = axis.take_events();
  REQUIRE(events.size() == 64);
  CHECK(std::abs(seconds(events[63].by - hours(63))) < 1e-6);
  CHECK(axis.missed_events() == 6);
  CHECK(axis.take_events().empty());
}

TEST_CASE("the system's clocks run, and a pair lies between its readings") {
  SystemClocks clocks;
  HostAxis axis(clocks);
  const HostTime before = axis.now();
  const ClockPair pair = axis.watch();
  CHECK(pair.raw >= before);
  CHECK(pair.raw <= axis.now());
  CHECK(to_ns(pair.utc) > 1'600'000'000'000'000'000);
  CHECK(!clocks.wall_was_set());
  CHECK(axis.epoch() == 0);
}

}  // namespace kinalign
