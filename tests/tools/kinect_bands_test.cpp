// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/rows.h"

#include <doctest/doctest.h>

#include <thread>

using namespace kinalign;

TEST_CASE("two simulated Kinects differ as real ones do: every band of seeds 1 to 20 is met") {
  const auto rows = camera_rows(20, std::thread::hardware_concurrency());
  REQUIRE(rows);
  CHECK(rows->size() == 18);
  for (const Row& row : *rows) {
    CAPTURE(row.name);
    CAPTURE(row.simulated);
    CHECK(row.met());
  }
}

TEST_CASE("a row is missed by what lies beside its band, and said to be") {
  std::vector<Row> rows{{"rms, cm", 4.0, 3.0, 5.0, 3.0}, {"share, %", 4.0, 3.0, 5.0, 5.01}};
  CHECK(rows[0].met());
  CHECK(!rows[1].met());
  CHECK(plain(rows) ==
        "met        3.000  real    4.000  band    3.000 to    5.000  rms, cm\n"
        "MISSED     5.010  real    4.000  band    3.000 to    5.000  share, %\n"
        "1 of 2 bands met\n");
}
