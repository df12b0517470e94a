// SPDX-License-Identifier: Apache-2.0
// Rows of several nodes in one stream: each node is judged by its own rows.
#include "kinalign/resample/arrival_lines.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

constexpr std::int64_t ms = 1'000'000, step = 33 * ms;
using Columns = std::vector<std::uint8_t>;
const Columns waist{1, 1, 0, 0}, wrist{0, 0, 1, 0}, both{0, 1, 1, 0}, ankle{0, 0, 0, 1};

std::size_t added(ArrivalLines& lines, std::int64_t t, const Columns& seen) {
  const auto line = lines.line_of(t, seen);
  REQUIRE(line);
  lines.add(*line, t, seen);
  return *line;
}

}  // namespace

TEST_CASE("a row goes on in the latest line with which it shares something") {
  ArrivalLines lines({step});
  CHECK(added(lines, 0, waist) == 0);
  CHECK(added(lines, 10 * ms, wrist) == 1);
  CHECK(added(lines, 20 * ms, ankle) == 2);
  CHECK(added(lines, 33 * ms, waist) == 0);
  CHECK(added(lines, 43 * ms, both) == 0);
  CHECK(added(lines, 76 * ms, wrist) == 0);
}

TEST_CASE("a row of which nothing was seen for long goes on in a line that has ended") {
  ArrivalLines lines({step});
  added(lines, 0, waist);
  CHECK(added(lines, 3 * step + 1, wrist) == 0);
  CHECK(added(lines, 3 * step + 2, ankle) == 1);
}

TEST_CASE(
    "only the last row of the same line is shown to have been held back, until it is left out") {
  ArrivalLines lines({step});
  for (std::int64_t k = 0; k < 10; ++k) {
    added(lines, k * step, waist);
    added(lines, k * step + ms / 10, wrist);
  }
  const std::int64_t behind = 9 * step + ms;
  CHECK(lines.shown_late(0, behind) == 9 * step);
  CHECK(lines.shown_late(1, behind) == 9 * step + ms / 10);
  CHECK(lines.open_since(behind) == 9 * step);
  lines.leave_out(1);
  CHECK_FALSE(lines.shown_late(1, behind));
  CHECK(lines.shown_late(0, behind));
  CHECK_FALSE(lines.shown_late(0, 9 * step + 7 * ms));  // a fifth of a step away
}

TEST_CASE("a row that was none leaves its line as it was") {
  ArrivalLines lines({step});
  added(lines, 0, waist);
  added(lines, step, waist);
  added(lines, step + ms, wrist);
  added(lines, 1000 * step, waist);
  lines.take_back();
  added(lines, 2 * step, waist);
  CHECK(lines.result() == Arrivals{});
  CHECK(lines.shown_late(0, 2 * step + ms) == 2 * step);
}

TEST_CASE("near rows of the reference are counted and none is left out") {
  ArrivalLines lines({step, Role::reference});
  for (std::int64_t k = 0; k < 10; ++k) added(lines, k / 2 * 2 * step + k % 2 * ms / 10, waist);
  CHECK(lines.result().near == 5);
  CHECK_FALSE(lines.shown_late(0, 8 * step + ms));
}

TEST_CASE("more lines than 64 are not judged") {
  ArrivalLines lines({step});
  for (std::size_t i = 0; i < 65; ++i) {
    Columns one(65, 0);
    one[i] = 1;
    const auto t = static_cast<std::int64_t>(i);
    const auto line = lines.line_of(t, one);
    CHECK(line.has_value() == (i < 64));
    if (line) lines.add(*line, t, one);
  }
}
