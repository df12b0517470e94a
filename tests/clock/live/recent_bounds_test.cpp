// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/recent_bounds.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace kinalign;

namespace {

constexpr double ms = 1e-3;
constexpr FloorLine level{};  // the old floor, at 0

/// Counts of `delays` delays half a millisecond above the old floor, and of `later` ones at `least`
/// above it.
ExcessCounts counts_of(int delays, int later, double least) {
  ExcessCounts counts;
  for (int i = 0; i < delays; ++i) counts.add(0.5 * ms);
  for (int i = 0; i < later; ++i) counts.add(least);
  return counts;
}

/// The bounds that came, when the floor was found to have moved, and when that was noticed, s.
struct Watched {
  RecentBounds bounds;
  ExcessCounts counts = counts_of(1000, 0, 0.0);
  std::optional<double> moved, seen_at;

  void add(double s, double excess, Standing standing) {
    bounds.add({s, excess}, standing);
    counts.add(excess);
    if (!moved && (moved = bounds.moved(level, counts))) seen_at = s;
  }
};

}  // namespace

TEST_CASE("a floor that rose is seen once a second is over, between its bounds and the old ones") {
  Watched watched;
  for (int i = 0; i <= 100; ++i) watched.add(0.1 * i, 0.1 * ms * (i % 5), Standing::usual);
  CHECK(!watched.moved);
  for (int i = 101; i <= 130; ++i) {
    watched.add(0.1 * i, 5 * ms + 0.1 * ms * (i % 5), Standing::above);
  }
  REQUIRE(watched.moved);
  CHECK(*watched.moved == about(10.05));
  CHECK(*watched.seen_at >= 11.1);
  CHECK(*watched.seen_at <= 11.4);  // it looks only at each third bound
}

TEST_CASE("a floor that fell is seen by the bounds that were held") {
  Watched watched;
  for (int i = 0; i <= 100; ++i) watched.add(0.1 * i, 0.1 * ms * (i % 5), Standing::usual);
  for (int i = 101; i <= 130; ++i) {
    watched.add(0.1 * i, -5 * ms + 0.1 * ms * (i % 5), Standing::held);
  }
  REQUIRE(watched.moved);
  CHECK(*watched.moved == about(10.05));
  CHECK(*watched.seen_at >= 11.1);
  CHECK(*watched.seen_at <= 11.4);
}

TEST_CASE("a busy radio, whose delays spread by more than their least one rose, is no new floor") {
  Watched watched;
  for (int i = 0; i < 300; ++i) watched.add(0.1 * i, 3 * ms + 0.8 * ms * (i % 20), Standing::above);
  CHECK(!watched.moved);
}

TEST_CASE("half of the first second's delays lie nearer than half of what the least one rose") {
  const auto seen_behind = [](double second_ms) {
    Watched watched;
    watched.counts = counts_of(0, 1000, 7 * ms);  // earlier delays that spread as widely
    for (int i = 0; i < 100; ++i) {
      const std::array excess{10 * ms, second_ms * ms, 17 * ms};
      watched.add(0.05 * i, excess[static_cast<std::size_t>(i) % 3], Standing::above);
    }
    return watched.seen_at.value_or(0.0);
  };
  CHECK(seen_behind(14.0) == about(1.0, 0.15));
  // More than half of it: the next look is at three seconds.
  CHECK(seen_behind(16.0) == about(3.0, 0.05));
}

TEST_CASE("one bound near the old floor restarts the seconds") {
  Watched watched;
  for (int i = 0; i < 300; ++i) {
    const bool near = i % 9 == 0;
    watched.add(0.1 * i, near ? 0.2 * ms : 5 * ms, near ? Standing::usual : Standing::above);
  }
  CHECK(!watched.moved);
}

TEST_CASE("if delays were often as long before, a decision takes three seconds, or nine") {
  const auto seen_behind = [](int near, int far) {
    Watched watched;
    watched.counts = counts_of(0, near, 1 * ms);
    for (int i = 0; i < far; ++i) watched.counts.add(6 * ms);
    for (int i = 0; i < 300; ++i) {
      watched.add(0.05 * i, (i % 3 == 2 ? 9 : 5) * ms, Standing::above);
    }
    return watched.seen_at.value_or(0.0);
  };
  // n delays as high as a share f of a thousand earlier ones have the likelihood ((f + 1) /
  // 1002)^n. That is e^-25 for 4 delays (f = 0), 37 (f = 500) and 154 (f = 850); 20 of them come in
  // a second.
  CHECK(seen_behind(1000, 0) == about(1.0, 0.15));
  CHECK(seen_behind(500, 500) == about(3.0, 0.05));
  CHECK(seen_behind(150, 850) == about(9.0, 0.02));
}

TEST_CASE("a node that sends seldom is watched for three or nine seconds, and for six bounds") {
  const auto bounds_until_seen = [](double step) {
    Watched watched;
    for (int i = 1; i <= 30; ++i) watched.add(step * i, 5 * ms, Standing::above);
    return watched.seen_at ? std::llround(*watched.seen_at / step) : 0;
  };
  // The eleventh bound comes a second after the first, and each third bound is looked at.
  CHECK(bounds_until_seen(0.1) == 12);
  CHECK(bounds_until_seen(0.4) == 9);
  CHECK(bounds_until_seen(1.0) == 12);
  CHECK(bounds_until_seen(2.0) == 0);
}

TEST_CASE("a floor has moved if the old floor has such delays once in e^25") {
  const auto moves = [](int points, const ExcessCounts& counts) {
    // `points` bounds in the last second, and some before: each third is looked at.
    RecentBounds bounds;
    for (int i = 0; i < 6 - points % 3; ++i) bounds.add({0.03 * i, 5 * ms}, Standing::above);
    for (int i = 1; i <= points; ++i) bounds.add({0.2 + 1.0 / points * i, 5 * ms}, Standing::above);
    return bounds.moved(level, counts).has_value();
  };
  // Six bounds above all n earlier ones have the likelihood 1 / (n + 2)^6, which is e^-25 at n =
  // 62.5.
  CHECK(!moves(6, counts_of(62, 6, 5 * ms)));
  CHECK(moves(6, counts_of(63, 6, 5 * ms)));
  CHECK(!moves(5, counts_of(1000, 5, 5 * ms)));  // six bounds are needed
  CHECK(!moves(12, counts_of(19, 12, 5 * ms)));  // 20 earlier delays are needed
  CHECK(moves(12, counts_of(20, 12, 5 * ms)));
  // n bounds, where 100 of 1000 earlier ones lay as high: likelihood (101 / 1002)^n, e^-25 at n =
  // 10.9.
  for (const auto& [points, sure] : {std::pair{9, false}, {12, true}}) {
    CAPTURE(points);
    ExcessCounts counts = counts_of(900, points, 5 * ms);
    for (int i = 0; i < 100; ++i) counts.add(5 * ms);
    CHECK(moves(points, counts) == sure);
  }
}

TEST_CASE("a floor that fell needs no evidence: a bound below it can't be of the old one") {
  RecentBounds bounds;
  for (int i = 0; i < 6; ++i) bounds.add({0.21 * i, -5 * ms}, Standing::held);
  CHECK(bounds.moved(level, counts_of(10, 6, -5 * ms)));
}

TEST_CASE("law: the newest are remembered, and how many of them came behind a moment") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::exponential_distribution<double> step(10.0);
    RecentBounds bounds;
    std::vector<double> came;
    const std::size_t most = 1 + random() % 600;
    for (double s = 0.0; came.size() < most; s += step(random)) {
      came.push_back(s);
      bounds.add({s, 2.0 * s}, Standing::usual);
    }
    const std::size_t kept = std::min<std::size_t>(most, 256);
    for (std::size_t i = 0; i < kept; ++i) {
      CHECK(bounds.newest(i).s == came[most - 1 - i]);
      CHECK(bounds.newest(i).x == 2.0 * came[most - 1 - i]);
    }
    const double moment = std::uniform_real_distribution<double>(-1.0, came.back() + 1.0)(random);
    const auto behind = static_cast<std::size_t>(
        std::count_if(came.end() - static_cast<std::ptrdiff_t>(kept), came.end(),
                      [moment](double s) { return s > moment; }));
    CHECK(bounds.behind(moment) == behind);
  }
}

TEST_CASE("it is silent around a moment where bounds are two and a half usual steps apart") {
  for (const double gap : {2.4, 2.7}) {
    CAPTURE(gap);
    RecentBounds bounds;
    for (int i = 0; i <= 50; ++i) bounds.add({0.1 * i, 0.0}, Standing::usual);
    for (int i = 0; i <= 50; ++i) bounds.add({5.0 + 0.1 * gap + 0.1 * i, 0.0}, Standing::usual);
    CHECK(bounds.silent_around(5.05) == (gap > 2.5));
    CHECK(!bounds.silent_around(4.95));
    CHECK(!bounds.silent_around(6.0));
    CHECK(bounds.silent_around(-1.0));  // nothing is known before the first bound
  }
}

TEST_CASE("before the first held bound is half way to the one before it, or a millisecond") {
  RecentBounds bounds;
  CHECK(!bounds.before_held());
  bounds.add({1.0, 0.0}, Standing::usual);
  CHECK(!bounds.before_held());
  bounds.add({2.0, -1.0}, Standing::held);
  bounds.add({3.0, 0.0}, Standing::usual);
  bounds.add({4.0, -1.0}, Standing::held);
  CHECK(*bounds.before_held() == 1.5);
  RecentBounds first;
  first.add({2.0, -1.0}, Standing::held);
  CHECK(*first.before_held() == about(1.999));
}

TEST_CASE("each held bound is released once, nine seconds later, the oldest first") {
  RecentBounds bounds;
  CHECK(!bounds.release(100.0));
  bounds.add({0.0, -1.0}, Standing::held);
  bounds.add({1.0, 0.0}, Standing::usual);
  bounds.add({3.0, -2.0}, Standing::held);
  CHECK(!bounds.release(8.99));
  const auto released = bounds.release(9.01);
  REQUIRE(released);
  CHECK(released->x == -1.0);
  CHECK(*bounds.before_held() == 2.0);
  CHECK(!bounds.release(11.99));
  CHECK(bounds.release(12.01)->x == -2.0);
  CHECK(!bounds.before_held());
  CHECK(!bounds.release(100.0));
}

TEST_CASE("a held bound that is forgotten meanwhile is not released") {
  RecentBounds bounds;
  bounds.add({0.0, -1.0}, Standing::held);
  for (int i = 1; i <= 256; ++i) bounds.add({0.01 * i, 0.0}, Standing::usual);
  CHECK(!bounds.release(20.0));
  CHECK(!bounds.before_held());
}
