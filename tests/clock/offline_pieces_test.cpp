// SPDX-License-Identifier: Apache-2.0
// Which exchange belongs to which piece of a recording, and what of it.
#include "kinalign/clock/offline_clock.h"
#include "kinalign/clock/offline_walk.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// A frame each 100 ms, a millisecond each way, without drift; each echoes the reply to the one
/// before, which reached the node two milliseconds after that frame left.
struct Talk {
  std::vector<Exchange> exchanges;
  Duration offset = 995s;  // host minus node

  void frame(Duration t, BootKey boot) {
    Exchange e{boot, NodeTime{t - offset}, HostTime{t + 1ms}, std::nullopt};
    if (!exchanges.empty() && exchanges.back().boot == boot) e.echo = echo_;
    exchanges.push_back(e);
    echo_ = {NodeTime{t + 2ms - offset}, HostTime{t + 1ms}};
  }
  void run(Duration from, Duration until, BootKey boot = 1) {
    for (Duration t = from; t < until; t += 100ms) frame(t, boot);
  }

 private:
  Exchange::Echo echo_;
};

}  // namespace

TEST_CASE("of two lives whose frames arrive at one moment each has its own") {
  Talk talk;
  talk.run(1000s, 1010s);
  talk.offset = 1009s + 900ms;
  talk.frame(1009s + 900ms, 2);
  REQUIRE(talk.exchanges[99].h_rx == talk.exchanges[100].h_rx);
  talk.run(1010s, 1020s, 2);
  const OfflineWalk walk = walk_offline(talk.exchanges, {});
  CHECK(walk.pieces.size() == 2);
  CHECK(walk.piece[99] == 0);
  CHECK(walk.piece[100] == 1);
  CHECK(range_of(walk, 0).end == 100);
  CHECK(range_of(walk, 1).end == 201);
}

TEST_CASE("what the first frame behind a step echoes is of before it") {
  for (const Duration by : {Duration{1s}, -Duration{1s}, Duration{20ms}, -Duration{20ms}}) {
    CAPTURE(by.count());
    Talk talk;
    talk.run(1000s, 1030s);
    talk.offset -= by;
    talk.run(1030s, 1060s);
    const OfflineClock offline = fit_offline_clock(talk.exchanges);
    REQUIRE(offline.model.pieces.size() >= 2);
    for (const ClockPieceModel& piece : offline.model.pieces) {
      CAPTURE(piece.first.time_since_epoch().count());
      const bool settles = piece.last - piece.first < 2s;  // it is in doubt, and likely
      CHECK(piece.certified != settles);
      const Duration truth = piece.first < HostTime{1030s} ? 995s : 995s - by;
      for (const ClockKnot& knot : piece.knots) {
        CHECK(knot.least <= truth);
        CHECK(std::chrono::abs(knot.offset - truth) < 10us);
        CHECK(truth <= knot.greatest);
        CHECK(knot.greatest - knot.least < 3ms);
      }
    }
  }
}
