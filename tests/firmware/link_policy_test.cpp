// SPDX-License-Identifier: Apache-2.0
#include "firmware/node/link_policy.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace kinalign;

namespace {

/// Steps ten times a second, and collects the actions with their second: "join 0".
struct Run {
  void go(int seconds, bool up, bool heard) {
    for (const int end = tenths + 10 * seconds; tenths < end; ++tenths) {
      const auto action = policy.step(static_cast<std::uint64_t>(tenths) * 100'000, up, heard);
      if (action == LinkAction::none) continue;
      wanted.push_back((action == LinkAction::join ? "join " : "restart ") +
                       std::to_string(tenths / 10));
    }
  }
  LinkPolicy policy;
  int tenths = 0;
  std::vector<std::string> wanted;
};

using Wanted = std::vector<std::string>;

}  // namespace

TEST_CASE("a node joins at once, and then in ever longer steps") {
  Run run;
  run.go(64, false, false);
  CHECK(run.wanted ==
        Wanted{"join 0", "join 1", "join 3", "join 7", "join 15", "join 31", "join 47", "join 63"});
}

TEST_CASE("a working link is left alone, and joined at once when it is lost") {
  Run run;
  run.go(5, false, false);
  run.go(3600, true, true);
  CHECK(run.wanted == Wanted{"join 0", "join 1", "join 3"});
  run.go(4, false, false);
  CHECK(run.wanted.size() == 6);
  CHECK(run.wanted[3] == "join 3605");
  CHECK(run.wanted[5] == "join 3608");
}

TEST_CASE("a link that comes and goes without an answer is not stormed") {
  Run run;
  for (int i = 0; i < 20; ++i) {
    run.go(1, true, false);
    run.go(1, false, false);
  }
  CHECK(run.wanted.size() == 20);  // one join each time the link is lost
}

TEST_CASE("a link without answers is joined again, less and less often") {
  Run run;
  run.go(1, true, true);
  run.go(1800, true, false);
  CHECK(run.wanted ==
        Wanted{"join 30", "join 90", "join 210", "join 450", "join 930", "join 1410"});
}

TEST_CASE("ten minutes without a link: the board restarts") {
  Run run;
  run.go(1, true, true);
  run.go(600, false, false);
  CHECK(run.wanted.back().substr(0, 4) == "join");
  run.go(1, false, false);
  CHECK(run.wanted.back() == "restart 601");
}

TEST_CASE("the watchdog is fed while samples are taken") {
  Watchdog watchdog;
  CHECK(watchdog.may_feed(10'000'000, 0));
  CHECK(watchdog.may_feed(11'000'000, 100));
  CHECK(watchdog.may_feed(13'000'000, 100));
  CHECK(!watchdog.may_feed(13'000'001, 100));
  CHECK(watchdog.may_feed(13'000'002, 101));
}
