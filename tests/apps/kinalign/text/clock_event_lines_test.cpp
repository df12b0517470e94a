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

/// A step of node 7 and its withdrawal, as events of the live clock.
void step(ClockEventLines& events, double s) {
  events.add(0, 7, event(Kind::step, s, s, 0.5), at(s));
  events.add(0, 7, event(Kind::withdrawn, s - 0.2, s), at(s));
}

const std::string stepped = "node 7: warning: its counter stepped by at least 500.000 ms";
const std::string keeps =
    "node 7: warning: its clock contradicts the assumptions again and again (drift above 100 ppm, "
    "or the node sleeps), so none of its stamps are certified; its steps are reported again after "
    "a "
    "minute without steps";

std::string withdrawn(const std::string& s) {
  return "node 7: warning: the stamps of " + s + " s are no longer certified";
}

}  // namespace

TEST_CASE("a step is printed before its withdrawn stamps, and these once") {
  ClockEventLines events;
  for (const double s : {20.0, 20.1}) {
    events.add(0, 7, event(Kind::violator, s, s), at(s));
    events.add(0, 7, event(Kind::withdrawn, s - 5, s), at(s));
  }
  CHECK(events.lines(at(20.15)).empty());  // no line yet: the cause may follow
  events.add(0, 7, event(Kind::step, 20, 20.2, -0.5), at(20.4));
  events.add(0, 7, event(Kind::withdrawn, 15, 20.2), at(20.4));
  CHECK(events.lines(at(20.4)) == Lines{stepped, withdrawn("5.2")});
  events.add(0, 7, event(Kind::settled, 21, 21.2), at(21.4));
  events.add(0, 7, event(Kind::withdrawn, 20, 21.2), at(21.4));
  CHECK(events.lines(at(25)) == Lines{"node 7: its counter runs evenly again"});
}

TEST_CASE("a withdrawal without a step is printed within a second, or at the end") {
  ClockEventLines events;
  events.add(0, 7, event(Kind::withdrawn, 15, 20), at(20));
  events.add(1, 8, event(Kind::withdrawn, 16, 20), at(20.5));
  CHECK(events.lines(at(20.9)).empty());
  CHECK(events.lines(at(21)) == Lines{withdrawn("5.0")});
  CHECK(events.last_lines() ==
        Lines{"node 8: warning: the stamps of 4.0 s are no longer certified"});
  CHECK(events.last_lines().empty());
}

TEST_CASE("a clock that steps thrice in ten seconds has one line more, and a minute's rest") {
  ClockEventLines events;
  step(events, 20);
  CHECK(events.lines(at(20)) == Lines{stepped, withdrawn("0.2")});
  step(events, 25);
  CHECK(events.lines(at(25)).size() == 2);
  CHECK_FALSE(events.contradicts(0, 7, at(25)));
  step(events, 30);
  CHECK(events.lines(at(30)) == Lines{keeps});
  for (double s = 31; s < 200; s += 0.3) {
    step(events, s);
    events.add(0, 7, event(Kind::settled, s, s), at(s));
    CHECK(events.lines(at(s)).empty());
    CHECK(events.contradicts(0, 7, at(s)));
  }
  CHECK_FALSE(events.contradicts(1, 7, at(200)));
  CHECK_FALSE(events.contradicts(0, 8, at(200)));
  CHECK(events.contradicts(0, 7, at(255)));
  CHECK_FALSE(events.contradicts(0, 7, at(260)));
  step(events, 260);
  CHECK(events.lines(at(260)) == Lines{stepped, withdrawn("0.2")});
}

TEST_CASE("each line has the node's name in its lab") {
  ClockEventLines events(NodeNames{"imu", {{"7", "wrist"}}});
  for (const double s : {20.0, 21.0, 22.0}) step(events, s);
  events.add(1, 8, event(Kind::settled, 22, 22), at(22));
  const auto lines = events.lines(at(30));
  REQUIRE(lines.size() == 4);
  CHECK(lines[0] == "imu wrist: warning: its counter stepped by at least 500.000 ms");
  CHECK(lines[2].starts_with("imu wrist: warning: its clock keeps contradicting"));
  CHECK(lines[3] == "imu 8: its counter runs evenly again");
}

TEST_CASE("steps far apart in time, and steps of other nodes, are printed each") {
  ClockEventLines events;
  for (const double s : {20.0, 26.0, 32.0, 38.0}) {
    step(events, s);
    events.add(1, 9, event(Kind::slip, s, s, 0.001), at(s));
    CHECK(events.lines(at(s)).size() == 3);
  }
}

TEST_CASE("a stream that is another node's now begins without what the one before had done") {
  ClockEventLines events;
  for (const double s : {20.0, 21.0, 22.0}) step(events, s);
  CHECK(events.contradicts(0, 7, at(22)));
  events.add(0, 8, event(Kind::step, 23, 23, 0.5), at(23));
  CHECK_FALSE(events.contradicts(0, 8, at(23)));
  CHECK(events.lines(at(23)).back() ==
        "node 8: warning: its counter stepped by at least 500.000 ms");
}

}  // namespace kinalign
