// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/point_rows.h"

#include "tests/formats/reading.h"

#include <doctest/doctest.h>

#include <array>

using namespace kinalign;

namespace {

/// Rows of a neck and two shoulders; `seen` false: the left shoulder was not seen.
struct Row {
  double left_x, right_x;
  bool seen = true;
};

Findings watched(const std::vector<Row>& rows, const std::string& left = "ShoulderLeft") {
  MirrorWatch watch({"Neck", left, "ShoulderRight"});
  for (const Row& row : rows) {
    const std::array<double, 9> places{0, 0, 2, row.left_x, 0, 2, row.right_x, 0, 2};
    const std::array<Tracking, 3> states{
        Tracking::missing, row.seen ? Tracking::inferred : Tracking::missing, Tracking::tracked};
    watch.watch(places.data(), states.data());
  }
  Findings out;
  watch.report("k.csv", out);
  return out;
}

constexpr Row upright{-0.2, 0.2}, mirrored{0.2, -0.2}, unseen{0.2, -0.2, false};

}  // namespace

TEST_CASE("a file is mirrored by most of the rows in which both shoulders were seen") {
  CHECK(watched({}).empty());
  CHECK(watched({upright, upright, mirrored}).empty());
  CHECK(watched({upright, mirrored}).empty());
  CHECK(watched({upright, unseen, unseen, unseen}).empty());
  const Findings said = watched({upright, mirrored, mirrored, unseen});
  REQUIRE(said.size() == 1);
  CHECK(said[0].severity == Severity::warning);
  CHECK(text_of(said[0]) ==
        "k.csv: expected the left shoulder at smaller x than the right one, found the left "
        "shoulder at larger x "
        "in 2 of 3 rows");
  CHECK(said[0].meaning == "the file is mirrored, or the person stood with the back to the sensor");
  CHECK(said[0].repair ==
        "if the file is mirrored, use a layout with x = \"-x\" and mirrored = true");
}

TEST_CASE("a skeleton without both shoulders is not watched") {
  CHECK(watched({mirrored, mirrored}, "ElbowLeft").empty());
}
