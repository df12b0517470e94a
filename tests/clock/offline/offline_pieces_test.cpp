// SPDX-License-Identifier: Apache-2.0
// How the exchanges of a recording are divided into pieces.
#include "kinalign/clock/offline/offline_clock.h"
#include "kinalign/clock/offline/offline_walk.h"

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
  Duration delay = 1ms;    // each way

  void frame(Duration t, BootKey boot = 1) {
    Exchange e{boot, NodeTime{t - offset}, HostTime{t + delay}, std::nullopt};
    if (!exchanges.empty() && exchanges.back().boot == boot) e.echo = echo_;
    exchanges.push_back(e);
    echo_ = {NodeTime{t + 2 * delay - offset}, HostTime{t + delay}};
  }
  void run(Duration from, Duration until, BootKey boot = 1) {
    for (Duration t = from; t < until; t += 100ms) frame(t, boot);
  }

 private:
  Exchange::Echo echo_;
};

HostTime host(Duration t) { return HostTime{t}; }

}  // namespace

TEST_CASE("two boots whose frames arrive at one moment have a piece each") {
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

TEST_CASE("the first frame after a step echoes a reply from before the step") {
  for (const Duration by : {Duration{1s}, -Duration{1s}, Duration{20ms}, -Duration{20ms}}) {
    CAPTURE(by.count());
    Talk talk;
    talk.run(1000s, 1030s);
    talk.offset -= by;
    talk.run(1030s, 1060s);
    const OfflineClock offline = fit_offline_clock(talk.exchanges);
    // Before the step, while the clock settles, and after that.
    REQUIRE(offline.model.pieces.size() == 3);
    for (const ClockPieceModel& piece : offline.model.pieces) {
      CAPTURE(piece.first.time_since_epoch().count());
      // The stamp is in doubt, but a likeliest one is given.
      const bool settles = piece.last - piece.first < 2s;
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

TEST_CASE("five seconds before and behind a crossing that can't be are in doubt, and no more") {
  Talk talk;
  talk.run(1000s, 1030s);
  talk.offset -= 1s;
  talk.frame(1030s);
  talk.offset += 1s;
  talk.run(1030s + 100ms, 1060s);
  const OfflineClock offline = fit_offline_clock(talk.exchanges);
  CHECK(offline.model.pieces.size() == 1);
  CHECK(offline.model.pieces[0].violators == 1);
  for (const Exchange& e : talk.exchanges) {
    const bool near = std::chrono::abs(e.h_rx - host(1030s + 1ms)) <= 5s;
    CHECK(is_in(offline.model.doubtful, e.h_rx) == near);
  }
}

TEST_CASE("a step that the end cuts short is in doubt since the last that speaks for the counter") {
  Talk talk;
  talk.run(1000s, 1200s);
  talk.delay = 20ms;  // slow packets, which support neither piece
  talk.run(1200s, 1210s);
  talk.delay = 1ms;
  talk.offset -= 4ms;
  talk.frame(1210s);
  talk.frame(1210s + 100ms);
  const OfflineWalk walk = walk_offline(talk.exchanges, {});
  CHECK(walk.pieces.size() == 1);
  CHECK(is_in(walk.doubtful, host(1203s)));
  CHECK(is_in(walk.doubtful, talk.exchanges.back().h_rx));
  CHECK(!is_in(walk.doubtful, host(1199s)));
}

TEST_CASE("a piece that never settles is in doubt, be it for a reboot or the end") {
  for (const bool reboots : {false, true}) {
    CAPTURE(reboots);
    Talk talk;
    talk.delay = 0ms;
    talk.run(1000s, 1010s);
    talk.offset -= 4us;  // less than a violation, but no interval is left
    talk.run(1010s, 1010s + 800ms);
    const HostTime last = talk.exchanges.back().h_rx;
    if (reboots) {
      talk.offset = 1019s;
      talk.run(1020s, 1030s, 2);
    }
    const OfflineWalk walk = walk_offline(talk.exchanges, {});
    CHECK(is_in(walk.doubtful, last));
    CHECK(!is_in(walk.doubtful, host(1025s)));
  }
}

TEST_CASE("a piece that begins with a step reaches back over late frames of an earlier boot") {
  Talk talk;
  talk.run(1000s, 1010s);
  const Exchange late{1, NodeTime{14s}, host(1040s + 50ms), std::nullopt};
  talk.offset = 1019s;
  talk.run(1020s, 1040s, 2);
  talk.offset -= 1s;
  talk.frame(1040s, 2);
  talk.exchanges.push_back(late);
  talk.frame(1040s + 100ms, 2);
  talk.frame(1040s + 200ms, 2);
  const OfflineWalk walk = walk_offline(talk.exchanges, {});
  const std::size_t n = talk.exchanges.size();
  REQUIRE(walk.late[n - 3]);
  CHECK(walk.pieces.size() == 3);
  for (std::size_t k = n - 4; k < n; ++k) CHECK(walk.piece[k] == 2);
  CHECK(walk.piece[n - 5] == 1);
}

TEST_CASE("fault 20 host_backwards: offline the moments that were twice are in doubt") {
  for (const Duration back : {Duration{3s}, Duration{30s}, Duration{3600s}}) {
    CAPTURE(back.count());
    Talk talk;
    talk.run(1000s, 1060s);
    talk.offset -= back;
    for (Duration t = 1060s - back; t < 1120s - back; t += 100ms) talk.frame(t);
    const OfflineClock offline = fit_offline_clock(talk.exchanges);
    REQUIRE(offline.model.pieces.size() >= 2);
    CHECK(offline.model.pieces[0].last == host(1059s + 901ms));
    CHECK(offline.model.pieces[1].first == host(1060s - back + 1ms));
    int certified = 0;
    for (const Exchange& e : talk.exchanges) {
      const auto stamp = host_from_node(offline.model, e.boot, e.n_tx, e.h_rx);
      if (!stamp || stamp->certainty != Certainty::certified) continue;
      ++certified;
      CHECK(*stamp->earliest <= e.h_rx - 1ms);
      CHECK(*stamp->latest >= e.h_rx - 1ms);
    }
    const int twice = back == 3600s ? 0 : 2 * static_cast<int>(back / 100ms);
    // The second piece settles, too: its first echo is of before the step.
    CHECK(certified > 1100 - twice);
  }
}

TEST_CASE("offline, too, a reading of before a step is not certified behind it") {
  Talk talk;
  talk.run(1000s, 1030s);
  talk.offset -= 1s;
  talk.run(1030s, 1060s);
  const OfflineClock offline = fit_offline_clock(talk.exchanges);
  const auto certainty = [&](NodeTime n) {
    return host_from_node(offline.model, 1, n, host(1040s + 1ms))->certainty;
  };
  CHECK(certainty(NodeTime{1040s - talk.offset}) == Certainty::certified);
  // A counter value of the first piece, sent in the second.
  CHECK(certainty(NodeTime{1028s - 995s}) == Certainty::doubtful);
}
