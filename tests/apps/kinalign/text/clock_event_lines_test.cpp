// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/clock_event_lines.h"

#include <doctest/doctest.h>

namespace kinalign {

namespace {

using Kind = ClockEvent::Kind;
using Lines = std::vector<std::string>;

HostTime at(double s) { return HostTime{Duration{static_cast<std::int64_t>(s * 1e9)}}; }

ClockEvent event(Kind kind, double begin, double end, double value = 0.0) {
  return {kind, 5, at(begin), at(end), value};
}

/// The lines about a step of node 7 and its withdrawal, as events of the live clock.
Lines step(ClockEventLines& clocks, double s) {
  Lines lines{clocks.line(0, 7, event(Kind::step, s, s, 0.5), at(s)),
              clocks.line(0, 7, event(Kind::withdrawn, s - 0.2, s), at(s))};
  std::erase(lines, "");
  return lines;
}

const std::string stepped = "node 7: warning: its counter stepped by at least 500.000 ms";
const std::string keeps =
    "node 7: warning: its clock keeps contradicting the assumptions (drift above 100 ppm, or the "
    "node sleeps), so none of its stamps are certified; its steps are reported again after a "
    "minute "
    "without steps";

std::string withdrawn(const std::string& s) {
  return "node 7: warning: the stamps of " + s + " s are no longer certified";
}

}  // namespace

TEST_CASE("stamps that several events withdraw have one line") {
  ClockEventLines clocks;
  CHECK(clocks.line(0, 7, event(Kind::withdrawn, 15, 20), at(20)) == withdrawn("5.0"));
  CHECK(clocks.line(0, 7, event(Kind::withdrawn, 15.1, 20.1), at(20.1)).empty());
  CHECK(clocks.line(0, 7, event(Kind::step, 20, 20.2, -0.5), at(20.4)) == stepped);
  CHECK(clocks.line(0, 7, event(Kind::withdrawn, 15, 20.2), at(20.4)).empty());
  CHECK(clocks.line(0, 7, event(Kind::settled, 21, 21.2), at(21.4)) ==
        "node 7: its counter runs evenly again");
  CHECK(clocks.line(0, 7, event(Kind::withdrawn, 30, 31), at(31)) == withdrawn("1.0"));
}

TEST_CASE("a clock that steps three times in ten seconds has one line more, until a quiet minute") {
  ClockEventLines clocks;
  CHECK(step(clocks, 20) == Lines{stepped, withdrawn("0.2")});
  CHECK(step(clocks, 25).size() == 2);
  CHECK_FALSE(clocks.contradicts(0, 7, at(25)));
  CHECK(step(clocks, 30) == Lines{keeps});
  for (double s = 31; s < 200; s += 0.3) {
    CHECK(step(clocks, s).empty());
    CHECK(clocks.line(0, 7, event(Kind::settled, s, s), at(s)).empty());
    CHECK(clocks.contradicts(0, 7, at(s)));
  }
  CHECK_FALSE(clocks.contradicts(1, 7, at(200)));
  CHECK_FALSE(clocks.contradicts(0, 8, at(200)));
  CHECK(clocks.contradicts(0, 7, at(255)));
  CHECK_FALSE(clocks.contradicts(0, 7, at(260)));
  CHECK(step(clocks, 260) == Lines{stepped, withdrawn("0.2")});
}

TEST_CASE("each line has the node's name in its lab") {
  ClockEventLines clocks(NodeNames{"imu", {{"7", "wrist"}}});
  CHECK(step(clocks, 20)[0] == "imu wrist: warning: its counter stepped by at least 500.000 ms");
  step(clocks, 21);
  CHECK(step(clocks, 22)[0].starts_with("imu wrist: warning: its clock keeps contradicting"));
  CHECK(clocks.line(1, 8, event(Kind::settled, 22, 22), at(22)) ==
        "imu 8: its counter runs evenly again");
}

TEST_CASE("steps of a node a long time apart, and those of others, have a line each") {
  ClockEventLines clocks;
  for (const double s : {20.0, 26.0, 32.0, 38.0}) {
    CHECK(step(clocks, s).size() == 2);
    CHECK_FALSE(clocks.line(1, 9, event(Kind::slip, s, s, 0.001), at(s)).empty());
  }
}

TEST_CASE("a stream that is another node's now begins without what the one before had done") {
  ClockEventLines clocks;
  for (const double s : {20.0, 21.0, 22.0}) step(clocks, s);
  CHECK(clocks.contradicts(0, 7, at(22)));
  CHECK(clocks.line(0, 8, event(Kind::step, 23, 23, 0.5), at(23)) ==
        "node 8: warning: its counter stepped by at least 500.000 ms");
  CHECK_FALSE(clocks.contradicts(0, 8, at(23)));
}

}  // namespace kinalign
