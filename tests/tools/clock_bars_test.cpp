// SPDX-License-Identifier: Apache-2.0
#include "tools/clock_table/bars.h"
#include "tools/clock_table/promises.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace kinalign;

namespace {

/// Figures that meet every bar.
LinkFigures perfect(Link link) {
  LinkFigures f;
  f.link = link;
  for (const StartBars& start : start_bars) {
    if (start.link == link) f.starts.push_back({start.limit});
  }
  f.restarts = f.starts;
  f.offline.frames = f.offline.certified = f.live.frames = f.live.certified = 1000;
  f.over_each_delay = f.over_mean_delay = {1e9, {1e9, 1}, 1e9};
  f.frame_number_gain = 1e9;
  f.rows[static_cast<std::size_t>(Method::each_delay)].pooled = 1e9;
  f.rows[static_cast<std::size_t>(Method::live)].pooled = 1e-9;
  return f;
}

std::vector<LinkFigures> perfect_links() {
  std::vector<LinkFigures> all;
  for (std::size_t i = 0; i < links; ++i) all.push_back(perfect(static_cast<Link>(i)));
  return all;
}

std::vector<std::string> missed(const RunSet& set, const std::vector<LinkFigures>& tables) {
  std::vector<std::string> columns;
  for (const Verdict& v : verdicts(set, tables)) {
    if (!v.met()) columns.push_back(v.source + " " + letter(v.link) + " " + v.column);
  }
  return columns;
}

}  // namespace

TEST_CASE("a bar is met by a figure that lies on it, and by none that is no number") {
  Verdict most{"5.3", Link::wired, "live", {0.005}, 0.005};
  CHECK(most.met());
  most.measured.value = 0.00501;
  CHECK(!most.met());
  Verdict least{"5.2", Link::paper, "gain", {100.0}, 100.0, true};
  CHECK(least.met());
  least.measured.value = 99.9;
  CHECK(!least.met());
  for (Verdict* v : {&most, &least}) {
    v->measured.value = std::numeric_limits<double>::quiet_NaN();
    CHECK(!v->met());
  }
}

TEST_CASE("every column that is promised of a length is judged") {
  // Numbers of bars, counted by hand in section 5. A minute: 47 for errors, 28 for coverage, 7 for
  // other clocks, 21 for widths, 16 for starts and 15 after a reboot, 5 for gains, 2 for the
  // reference. Ten minutes: 48, 28, 21, 0, 4, 4. An hour: 43, 28, 21. Bursts: 47, 28.
  const auto all = perfect_links();
  CHECK(verdicts({.minutes = 1.0}, all).size() == 141);
  CHECK(verdicts({.minutes = 10.0}, all).size() == 105);
  CHECK(verdicts({.minutes = 60.0}, all).size() == 92);
  CHECK(verdicts({.minutes = 1.0, .bursts = true}, all).size() == 75);
  for (const double minutes : {1.0, 10.0, 60.0}) CHECK(missed({.minutes = minutes}, all).empty());
}

TEST_CASE("a figure beyond its bar is missed, and it alone") {
  auto all = perfect_links();
  const auto of = [&](Link link) -> LinkFigures& { return all[static_cast<std::size_t>(link)]; };
  of(Link::wired).rows[static_cast<std::size_t>(Method::offline)].pooled = 0.0055e-3;
  of(Link::congested).live.outside = 1;
  of(Link::quiet).live.certified = 969;
  of(Link::paper).over_mean_delay.least = {92.0, 71'023};
  of(Link::thin_floor).starts[0].p90 = 2.1;
  of(Link::congested).restarts[0] = {1e-3, 1.7, 10.1};  // the median is not promised there
  of(Link::roaming).outside_of_other_clocks = 1;
  using Columns = std::vector<std::string>;
  CHECK(missed({.minutes = 1.0}, all) ==
        Columns{"5.3 A offline, pooled RMS, ms", "ours B live, share of frames that stay certified",
                "5.2 C gain, offline, over mean d, every seed",
                "5.4 E live, truths outside their interval",
                "5.5 E after a reboot, live under 1 ms, p90, s",
                "5.4 F other clocks, truths outside their interval",
                "5.5 G start, live under 5 ms, p90, s"});
  // After an hour 0.006 ms are allowed on A. With bursts the bars are twice those of a minute, and
  // no gain is promised.
  const Columns lie{"ours B live, share of frames that stay certified",
                    "5.4 E live, truths outside their interval"};
  CHECK(missed({.minutes = 60.0}, all) == lie);
  CHECK(missed({.minutes = 1.0, .bursts = true}, all) == lie);
}

TEST_CASE("the seed that a worst figure names gives that figure alone") {
  const RunSet set{.minutes = 1.0, .seeds = 4, .first = 71'000};
  const LinkFigures all = measure(Link::paper, set);
  const auto alone = [&](Extreme worst) {
    return measure(Link::paper, {.minutes = 1.0, .seeds = 1, .first = worst.seed.value()});
  };
  const MethodFigures& live = all.of(Method::live);
  CHECK(alone(live.worst_stamp).of(Method::live).worst_stamp.value == live.worst_stamp.value);
  CHECK(alone(live.worst_seed).of(Method::live).worst_seed.value == live.worst_seed.value);
  const Extreme least = all.over_mean_delay.least;
  CHECK(alone(least).over_mean_delay.least.value == least.value);
}
