// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/host_from_node.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

constexpr HostTime host(Duration d) { return HostTime{d}; }
constexpr NodeTime node(Duration d) { return NodeTime{d}; }

/// One piece for life 7, heard from 100 to 110 s of the host. The counter is 90 s behind, and then
/// loses another 10 us a second.
HostFromNode one_piece() {
  ClockPieceModel piece;
  piece.boot = 7;
  piece.first = host(100s);
  piece.last = host(110s);
  piece.certified = true;
  piece.knots = {{node(10s), 90s, 90s - 1ms, 90s + 2ms},
                 {node(11s), 90s - 10us, 90s - 2ms, 90s + 2ms}};
  return {{piece}, {}};
}

}  // namespace

TEST_CASE(
    "between knots likeliest and ends are straight, and half a microsecond is the counter's") {
  const auto stamp = host_from_node(one_piece(), 7, node(10s + 500ms), host(101s));
  REQUIRE(stamp);
  CHECK(stamp->time == host(100s + 500ms - 5us + 500ns));
  CHECK(*stamp->earliest == host(100s + 500ms - 1500us));
  CHECK(*stamp->latest == host(100s + 500ms + 2ms + 1us));
  CHECK(stamp->certainty == Certainty::certified);
}

TEST_CASE("offsets beyond a double's precision lose no nanosecond") {
  const Duration far = -130 * 365 * 24h - 123'456'789ns;  // the counter was set to the time of day
  ClockPieceModel piece = one_piece().pieces[0];
  for (ClockKnot& knot : piece.knots) {
    knot.node -= far;
    knot.offset += far;
    knot.least += far;
    knot.greatest += far;
  }
  const HostFromNode model{{piece}, {}};
  for (const Duration n :
       {Duration{9s}, Duration{10s}, 10s + 500'000'000ns, 10s + 999'999'999ns, Duration{12s}}) {
    const auto near = host_from_node(one_piece(), 7, node(n), host(101s));
    const auto stamp = host_from_node(model, 7, node(n) - far, host(101s));
    REQUIRE(stamp);
    CHECK(stamp->time == near->time);
    CHECK(stamp->earliest == near->earliest);
    CHECK(stamp->latest == near->latest);
  }
}

TEST_CASE("beyond the knots the interval opens by the greatest rate") {
  const auto stamp = host_from_node(one_piece(), 7, node(13s), host(105s));
  REQUIRE(stamp);
  CHECK(stamp->time == host(103s - 10us + 500ns));
  CHECK(*stamp->earliest == host(103s - 2ms - 200us));
  CHECK(*stamp->latest == host(103s + 2ms + 201us));
}

TEST_CASE("another boot, another time, and an unknown piece have no stamp") {
  HostFromNode model = one_piece();
  CHECK(!host_from_node(model, 8, node(10s), host(101s)));
  CHECK(!host_from_node(model, 7, node(10s), host(111s)));
  model.pieces[0].knots.clear();
  CHECK(!host_from_node(model, 7, node(10s), host(101s)));
}

TEST_CASE("stamps of frames that arrived in a doubtful stretch are not certified") {
  HostFromNode model = one_piece();
  model.doubtful = {{host(102s), host(103s)}};
  CHECK(host_from_node(model, 7, node(10s), host(102s))->certainty == Certainty::doubtful);
  CHECK(host_from_node(model, 7, node(10s), host(103s) + 1ns)->certainty == Certainty::certified);
}
