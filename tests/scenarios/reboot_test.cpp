// SPDX-License-Identifier: Apache-2.0
// Faults 1 and 3 exactly as in docs/faults.md: the start of a node's new life, and how soon its
// stamps are good.
#include "tests/scenarios/minutes.h"
#include "tests/seeds.h"
#include "tools/clock_table/judge.h"
#include "tools/clock_table/promises.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

using namespace kinalign;

namespace {

/// The frames of one life of a node that were received: the first and the last arrival, and the
/// number of bounds in each direction.
struct HeardLife {
  HostTime first{HostTime::max()}, last{HostTime::min()};
  std::uint64_t up = 0, down = 0;
};

std::map<BootKey, HeardLife> lives_of(const std::vector<Exchange>& exchanges) {
  std::map<BootKey, HeardLife> lives;
  for (const Exchange& e : exchanges) {
    HeardLife& life = lives[e.boot];
    life.first = std::min(life.first, e.h_rx);
    life.last = std::max(life.last, e.h_rx);
    ++life.up;
    life.down += e.echo ? 1 : 0;
  }
  return lives;
}

ExchangeOptions rebooting(Link link, double at) {
  ExchangeOptions options = minutes(link, 1.0);
  options.reboots = {{.at = at, .gap = 1.0}};
  return options;
}

/// The time at which the first frame of the second life arrives, s.
double second_life(const SimulatedExchanges& simulated) {
  const auto lives = lives_of(exchanges_of(simulated));
  REQUIRE(lives.size() == 2);
  return std::max(seconds_of(lives.begin()->second.first),
                  seconds_of(lives.rbegin()->second.first));
}

/// Seconds from `first_heard` until the error stays under the limit for 10 s.
double good_after(const JudgedRun& run, double first_heard, double limit) {
  double good = first_heard;
  for (const JudgedStamp& stamp : run.stamps) {
    if (stamp.arrival < first_heard) continue;
    if (stamp.arrival - good > 10.0) break;
    if (std::abs(stamp.error) > limit) good = stamp.arrival;
  }
  return good - first_heard;
}

}  // namespace

TEST_CASE("fault 1 reboot: the new piece begins with the first frame received") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    for (int link = 0; link < links; ++link) {
      const auto exchanges =
          exchanges_of(simulate_exchanges(rebooting(static_cast<Link>(link), 30.0), seed));
      LiveClock clock;
      BootKey present = exchanges.front().boot;
      std::set<BootKey> told, earlier;
      for (const Exchange& e : exchanges) {
        const bool begins = told.insert(e.boot).second;
        if (begins && e.boot != present) earlier.insert(std::exchange(present, e.boot));
        clock.push(e);
        const auto events = clock.take_events();
        const auto born = std::find_if(events.begin(), events.end(), [](const ClockEvent& event) {
          return event.kind == ClockEvent::Kind::new_boot;
        });
        CHECK((born != events.end()) == begins);
        if (!begins) continue;
        CHECK(born->boot == e.boot);
        CHECK(born->begin == e.h_rx);
        // Nothing of the old model is left, neither for the new counter nor for the old one.
        CHECK(clock.piece()->origin().node == e.n_tx);
        CHECK(!clock.piece()->floors().window(0));
        if (!e.echo) CHECK(!clock.host_from_node(e.boot, e.n_tx));
        for (const BootKey boot : earlier) CHECK(!clock.host_from_node(boot, e.n_tx));
      }
      CHECK(told.size() == 2);
      CHECK(earlier.size() == 1);
    }
  }
}

TEST_CASE("fault 1 reboot: after it the bars of a start hold") {
  // Promise 4: the median of the time until the live error is good, and its 90th percentile. On E
  // and F they hold for a start in a good state and on the first route.
  const auto seeds = fresh_seeds(300);
  for (const StartBars& bar : start_bars) {
    if (bar.link == Link::congested || bar.link == Link::roaming) continue;
    CAPTURE(letter(bar.link));
    CAPTURE(bar.limit);
    std::vector<double> times;
    for (const auto seed : seeds) {
      const auto exchanges = simulate_exchanges(rebooting(bar.link, 30.0), seed);
      const auto run = judge_live(exchanges);
      CHECK(run.lies() == 0);
      times.push_back(good_after(run, second_life(exchanges), bar.limit));
    }
    std::sort(times.begin(), times.end());
    if (seeds.size() == 1) continue;
    CHECK(times[times.size() / 2] <= bar.median);
    CHECK(times[times.size() * 9 / 10] <= bar.p90);
  }
}

TEST_CASE("fault 1 reboot: it is good no later than a node that first sends then") {
  for (const StartBars& bar : start_bars) {
    CAPTURE(letter(bar.link));
    int later = 0, sooner = 0;
    for (const auto seed : fresh_seeds(60)) {
      SimulatedExchanges exchanges =
          simulate_exchanges(rebooting(bar.link, 30.0 + static_cast<double>(seed % 8)), seed);
      const double first = second_life(exchanges);
      const double after = good_after(judge_live(exchanges), first, bar.limit);
      for (SimulatedFrame& frame : exchanges.frames) {
        if (frame.boot_id == exchanges.frames.front().boot_id) frame.arrival.reset();
      }
      const double fresh = good_after(judge_live(exchanges), first, bar.limit);
      later += after > fresh + 1.0 ? 1 : 0;
      sooner += fresh > after + 1.0 ? 1 : 0;
    }
    CHECK(later <= sooner + 5);  // 1000 seeds differ by 4 on link E, and by at most 1 on the others
  }
}

TEST_CASE("fault 3 reboot_storm: each boot is a piece, certified from two up and one down on") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    for (const Link link : {Link::quiet, Link::paper, Link::congested}) {
      CAPTURE(letter(link));
      // Then that life lasts for 1.5 s, or for three frames.
      for (const double gap : {0.5, 1.8, 1.9}) {
        CAPTURE(gap);
        ExchangeOptions options = minutes(link, 1.0);
        for (int i = 0; i < 10; ++i) options.reboots.push_back({.at = 20.0 + 2.0 * i, .gap = gap});
        const SimulatedExchanges simulated = simulate_exchanges(options, seed);
        const auto exchanges = exchanges_of(simulated);
        const auto lives = lives_of(exchanges);

        LiveClock live;
        std::map<BootKey, HeardLife> so_far;
        for (const Exchange& e : exchanges) {
          live.push(e);
          HeardLife& life = so_far[e.boot];
          ++life.up;
          life.down += e.echo ? 1 : 0;
          const auto stamp = live.host_from_node(e.boot, e.n_tx);
          if (life.down == 0) CHECK(!stamp);
          if (stamp && life.up < 2) CHECK(stamp->certainty != Certainty::certified);
        }

        const auto events = live.take_events();
        CHECK(std::count_if(events.begin(), events.end(), [](const ClockEvent& event) {
                return event.kind == ClockEvent::Kind::new_boot;
              }) == static_cast<int>(lives.size()));

        const OfflineClock offline = fit_offline_clock(exchanges);
        std::map<BootKey, int> pieces;
        for (const ClockPieceModel& piece : offline.model.pieces) {
          ++pieces[piece.boot];
          CHECK(piece.certified == (piece.up >= 2 && piece.down >= 1));
        }
        for (const auto& [boot, life] : lives) CHECK(pieces[boot] == 1);
        CHECK(pieces.size() == lives.size());
        for (const Exchange& e : exchanges) {
          const HeardLife& life = lives.at(e.boot);
          if (life.up >= 2 && life.down >= 1) continue;
          const auto stamp = host_from_node(offline.model, e.boot, e.n_tx, e.h_rx);
          if (stamp) CHECK(stamp->certainty != Certainty::certified);
        }
        CHECK(judge_live(simulated).lies() == 0);
        CHECK(judge_offline(simulated).lies() == 0);
      }
    }
  }
}
