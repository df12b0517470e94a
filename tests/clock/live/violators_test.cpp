// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/live/violators.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr double rate = 100e-6;

constexpr HostTime host(Duration d) { return HostTime{1000s + d}; }

/// A frame that arrives a millisecond before it can have been sent.
Violator early(Duration arrival, std::uint64_t number = 0) {
  return {{Side::above, NodeTime{arrival}, host(arrival), host(arrival)},
          {seconds(arrival), -1e-3, Side::above},
          1e-3,
          number};
}

}  // namespace

TEST_CASE("two bounds contradict each other where not even the greatest rate leads between them") {
  const Bound above{10.0, 0.0, Side::above};
  CHECK(contradict(above, {10.0, 6e-6, Side::below}, rate));
  CHECK(contradict({10.0, 6e-6, Side::below}, above, rate));
  CHECK(!contradict(above, {10.0, 4e-6, Side::below}, rate));  // within the tolerance
  CHECK(contradict(above, {12.0, 2.1e-4, Side::below}, rate));
  CHECK(!contradict(above, {12.0, 1.9e-4, Side::below}, rate));
  CHECK(!contradict(above, {8.0, 1.9e-4, Side::below}, rate));
  // Two bounds of one side never contradict each other.
  CHECK(!contradict(above, {10.0, 1.0, Side::above}, rate));
}

TEST_CASE("a violator is dropped when a later crossing excludes it, and by no other") {
  Violators violators;
  violators.add(early(10s));
  // The frame may have been sent before.
  violators.drop_excluded_by({10.9, 0.0, Side::below}, rate);
  violators.drop_excluded_by({12.0, -2e-3, Side::below}, rate);
  violators.drop_excluded_by({12.0, 0.0, Side::above}, rate);
  CHECK(violators.pending().size() == 1);
  violators.drop_excluded_by({12.0, 0.0, Side::below}, rate);
  CHECK(violators.pending().empty());
}

TEST_CASE("a violator that nothing speaks against for five seconds is overdue") {
  Violators violators;
  CHECK(!violators.overdue(host(60s), 1000));
  violators.add(early(10s, 100));
  CHECK(!violators.overdue(host(15s), 1000));
  CHECK(violators.overdue(host(15s + 1ns), 1000));
  CHECK(!violators.overdue(host(60s), 108));  // the node seldom sends
  CHECK(violators.overdue(host(60s), 109));
}

TEST_CASE("three are as many as there can be") {
  Violators violators;
  for (int i = 0; i < 3; ++i) {
    CHECK(!violators.full());
    violators.add(early(10s + 1s * i));
  }
  CHECK(violators.full());
  CHECK(violators.pending()[2].crossing.arrival == host(12s));
}
