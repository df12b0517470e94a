// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/clock_piece.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;
using Verdict = ClockPiece::Verdict;

namespace {

constexpr HostTime host(Duration d) { return HostTime{1000s + d}; }
constexpr NodeTime node(Duration d) { return NodeTime{5s + d}; }

/// A node without drift; the offset is 995 s until the counter steps ahead by `stepped`.
struct Talk {
  ClockPiece piece{{node(0s), host(0s)}, {}};
  Duration stepped{0}, up = 1ms, down = 1ms;
  std::vector<Bound> bounds{};

  Verdict frame(Duration t) {
    bounds.push_back({seconds(t + stepped), seconds(up - stepped), Side::above});
    return piece.push({Side::above, node(t + stepped), host(t + up), host(t + up)});
  }
  /// Pushes a reply; its bound arrives ten milliseconds later, in the frame that echoes it.
  Verdict reply(Duration t) {
    // A reading n of the counter, in whole microseconds, stands for times up to n + 1 us at which
    // the reply came.
    bounds.push_back({seconds(t + stepped), seconds(-down - stepped) - 1e-6, Side::below});
    return piece.push({Side::below, node(t + stepped), host(t - down), host(t + 10ms)});
  }
  /// Gives the last verdict, or the first one that is not `taken`.
  Verdict run(Duration from, Duration until, Duration step) {
    for (Duration t = from; t < until; t += step) {
      if (const Verdict v = frame(t); v != Verdict::taken) return v;
      if (const Verdict v = reply(t + 5ms); v != Verdict::taken) return v;
      at = t;
    }
    return Verdict::taken;
  }
  Duration at{0};  // time of the last exchange that was taken
};

/// The same with random delays above both floors, 0.01 ms on average.
struct Jittery : Talk {
  std::mt19937_64 random{1};
  std::exponential_distribution<double> above{1e5};
  Duration up_floor = 1ms, down_floor = 1ms;

  Verdict run(Duration from, Duration until) {
    for (Duration t = from; t < until; t += 100ms) {
      up = up_floor + Duration{static_cast<std::int64_t>(above(random) * 1e9)};
      down = down_floor + Duration{static_cast<std::int64_t>(above(random) * 1e9)};
      if (const Verdict v = Talk::run(t, t + 1ns, 1s); v != Verdict::taken) return v;
    }
    return Verdict::taken;
  }
};

/// An independent slow way: the interval of x(t) that all slopes up to 100 ppm leave, tried one by
/// one, under bounds that may be off by 0.05 ppm a second.
struct Left {
  double low = 1e9, high = -1e9;
};

Left left_by(const std::vector<Bound>& bounds, double t) {
  Left left;
  for (int i = -10'000; i <= 10'000; ++i) {
    const double slope = 100e-6 * i / 10'000;
    double low = -1e9, high = 1e9;
    for (const Bound& b : bounds) {
      const double tau = b.s - t, bent = 5e-8 * tau * tau / 2.0;
      if (b.side == Side::above) high = std::min(high, b.x + bent - slope * tau);
      if (b.side == Side::below) low = std::max(low, b.x - bent - slope * tau);
    }
    if (low > high) continue;
    left.low = std::min(left.low, low);
    left.high = std::max(left.high, high);
  }
  return left;
}

}  // namespace

TEST_CASE("a stamp's interval is what all crossings leave, with the microsecond of a counter") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<std::int64_t> delay(1'000'000, 9'000'000), step(1000, 100'000);
    ClockPiece piece({node(0s), host(0s)}, {});
    std::vector<Bound> bounds;
    Duration n{0};  // the counter's reading, whole microseconds; it loses 20 ppm
    for (int i = 0; i < 80; ++i) {
      n += std::chrono::microseconds(step(random));
      const Duration x = n / 50'000, up{delay(random)}, down{delay(random)};
      piece.push({Side::above, node(n), host(n + x + up), host(n + x + up)});
      piece.push({Side::below, node(n), host(n + x - down), host(n + x + up)});
      bounds.push_back({seconds(n), seconds(x + up), Side::above});
      bounds.push_back({seconds(n), seconds(x - down) - 1e-6, Side::below});
    }
    for (const Duration t : {n, n / 2, n + 2s}) {
      const auto stamp = piece.at(node(t));
      REQUIRE(stamp);
      CHECK(stamp->certainty == Certainty::certified);
      const Left left = left_by(bounds, seconds(t));
      // The slopes that are tried are 0.01 ppm apart, which is 0.1 us over ten seconds.
      CHECK(std::abs(seconds(*stamp->earliest - host(t)) - left.low) < 0.1e-6);
      CHECK(std::abs(seconds(*stamp->latest - host(t)) - 1e-6 - left.high) < 0.1e-6);
    }
  }
}

TEST_CASE("a piece reaches three years to each side, and no further") {
  Talk talk;
  talk.run(0s, 10s, 100ms);
  const Duration three_years = 100'000'000s;
  CHECK(talk.piece.at(node(three_years)));
  CHECK(!talk.piece.at(node(three_years + 1s)));
  CHECK(!talk.piece.at(node(-three_years - 1s)));
  CHECK(talk.frame(three_years + 1s) == Verdict::violator);
}

TEST_CASE("a crossing is against the certificate by more than five microseconds") {
  for (const Side side : {Side::above, Side::below}) {
    for (const Duration by : {4us, 6us}) {
      CAPTURE(by.count());
      Talk talk;
      talk.run(0s, 30s, 100ms);
      const auto stamp = talk.piece.at(node(30s));
      const HostTime h =
          side == Side::above ? *stamp->earliest - by : *stamp->latest + by;  // plus 1 us each way
      CHECK(talk.piece.push({side, node(30s), h, host(30s)}) ==
            (by > 5us ? Verdict::violator : Verdict::taken));
      CHECK(*talk.piece.amount() == about(seconds(by), 1e-3));
    }
  }
}

TEST_CASE("the third violator ends a piece; the next begins with the first of them") {
  Talk talk;
  talk.run(0s, 30s, 100ms);
  const double believed = talk.piece.estimate().slope().deviation;
  talk.stepped = 1s;
  CHECK(talk.frame(30s) == Verdict::violator);
  CHECK(talk.piece.at(node(30s))->certainty == Certainty::doubtful);
  CHECK(talk.frame(30s + 100ms) == Verdict::violator);
  CHECK(talk.frame(30s + 200ms) == Verdict::broken);
  CHECK(*talk.piece.amount() == about(0.998, 1e-3));  // the step, less the delays both ways
  CHECK(talk.piece.next_begins() == host(30s + 1ms));
  CHECK(talk.piece.doubtful_since() == host(25s + 1ms));  // five seconds before
  const ClockPiece next = talk.piece.next_piece();
  CHECK(next.origin().node == node(31s));
  CHECK(next.origin().host == host(30s + 1ms));
  CHECK(next.assumptions() == Assumptions{});  // no crystal drifts that fast
  CHECK(next.estimate().slope().deviation >= believed + 1.9e-6);
}

TEST_CASE("stamps since the last crossing that fits the old counter are in doubt") {
  Talk talk;
  talk.run(0s, 200s, 100ms);
  talk.down = talk.up = 20ms;  // slow packets, which support neither counter
  talk.run(200s, 210s, 100ms);
  talk.stepped = 4ms;
  talk.up = 1ms;
  for (int i = 0; i < 3; ++i) talk.frame(210s + 100ms * i);
  // The last fast reply left at 199.905 s minus its delay of a millisecond.
  CHECK(seconds(talk.piece.doubtful_since() - host(199s + 905ms - 1ms)) ==
        doctest::Approx(0.0).epsilon(2e-6));
}

TEST_CASE("a crystal is believed to run as before a step, to two millionths") {
  Talk talk;
  talk.run(0s, 30s, 100ms);
  talk.stepped = 2500us;
  CHECK(talk.frame(31s) == Verdict::violator);
  talk.up = talk.down = 11ms;  // for five seconds no packet contradicts it
  CHECK(talk.run(31s + 100ms, 40s, 100ms) == Verdict::broken);
  CHECK(talk.at > 35s);
  CHECK(talk.at < 37s);
  const SlopeBelief before = talk.piece.estimate().slope();
  const ClockPiece next = talk.piece.next_piece();
  CHECK(next.estimate().slope().mean == before.mean);
  CHECK(next.estimate().slope().deviation == about(before.deviation + 2e-6));
  CHECK(talk.piece.next_begins() == host(talk.at + 100ms + 11ms));
}

TEST_CASE("bounds that leave no way between them end a piece, which is in doubt as a whole") {
  Talk talk;
  talk.up = talk.down = 0ms;
  talk.run(0s, 10s, 100ms);
  talk.stepped = 4us;  // less than the tolerance, but more than the interval's width
  CHECK(talk.run(10s, 20s, 100ms) == Verdict::broken);
  CHECK(talk.at < 11s);
  CHECK(!talk.piece.amount());  // it is not known which of them is wrong
  CHECK(talk.piece.doubtful_since() == host(0s));
  CHECK(talk.piece.next_begins() >= host(10s));
}

TEST_CASE("an interval narrower than packets take, a minute ago, ends a piece") {
  // Two exchanges a second: a piece remembers 255 corners each way, and here each bound is a
  // corner. Almost no packet comes for fifty seconds, and in their middle the counter steps by half
  // of both delays. The allowed band leads from one corner to the other, and is narrow only there.
  Talk talk;
  CHECK(talk.run(0s, 50s, 500ms) == Verdict::taken);
  CHECK(talk.run(50s, 75s, 5s) == Verdict::taken);
  talk.stepped = 1ms;
  CHECK(talk.run(75s, 100s, 5s) == Verdict::taken);
  CHECK(talk.run(100s, 140s, 500ms) == Verdict::slipped);
  CHECK(talk.at > 109s);  // once a whole window has shown how long packets take
  CHECK(talk.at < 121s);
  double narrowest = 1.0;
  for (int window = 0; window < 12; ++window) {
    const Left left = left_by(talk.bounds, talk.bounds.back().s - 5.0 - 10.0 * window);
    narrowest = std::min(narrowest, left.high - left.low);
  }
  CHECK(narrowest < 1.3e-3);
  const double least = talk.piece.floors().least_width();
  CHECK(least == about(0.8 * 2e-3, 0.02));  // the packets take 2 ms both ways; a fifth is allowed
  CHECK(*talk.piece.amount() == about(least - narrowest, 0.01));
  CHECK(talk.piece.doubtful_since() == host(0s));  // it is not known since when
  CHECK(talk.piece.next_begins() == host(talk.at + 500ms + 1ms));
}

TEST_CASE("a step that leaves the truth inside is a warning, a greater one ends the piece") {
  for (const Duration by : {1ms, -1ms, 2ms, -2ms}) {
    CAPTURE(by.count());
    Jittery talk;
    talk.up_floor = talk.down_floor = 3ms;
    CHECK(talk.run(0s, 100s) == Verdict::taken);
    talk.stepped = by;
    const Verdict verdict = talk.run(100s, 130s);
    if (std::chrono::abs(by) == 1ms) {  // a small step: the round trip is 6 ms
      CHECK(verdict == Verdict::uneasy);
      CHECK(*talk.piece.amount() == about(-seconds(by), 0.05));  // the step of the offset
      CHECK(talk.piece.at(node(talk.at))->certainty == Certainty::certified);
    } else {
      CHECK(verdict == Verdict::slipped);
      CHECK(talk.piece.doubtful_since() < host(100s));
    }
  }
}

TEST_CASE("if both floors move, the stamps of the previous five seconds are in doubt") {
  Jittery talk;
  talk.up_floor = talk.down_floor = 3ms;
  CHECK(talk.run(0s, 101s) == Verdict::taken);
  talk.stepped = 3ms;
  CHECK(talk.run(101s, 130s) == Verdict::slipped);
  CHECK(talk.at < 113s);  // one second to notice it, eight to know the new floors
  CHECK(*talk.piece.amount() == about(-3e-3, 0.05));
  CHECK(std::chrono::abs(talk.piece.doubtful_since() - host(96s)) < 200ms);
  CHECK(talk.piece.next_begins() >= host(talk.at));
  // The next piece knows its offset, but certifies nothing from earlier packets.
  ClockPiece next = talk.piece.next_piece();
  const auto stamp = next.at(node(talk.at + talk.stepped));
  REQUIRE(stamp);
  CHECK(std::chrono::abs(stamp->time - host(talk.at)) < 50us);
  CHECK(stamp->certainty != Certainty::certified);
  CHECK(!stamp->earliest);
  CHECK(next.doubtful_since() >= host(talk.at));
}
