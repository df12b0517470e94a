// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/trc.h"

#include "tests/io/reading.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace kinalign;

namespace {

std::string head(const std::string& frames, const std::string& unit = "mm") {
  return "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
         "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
         "OrigNumFrames\n100\t100\t" +
         frames + "\t2\t" + unit +
         "\t100\t1\t2\nFrame#\tTime\tHEAD\t\t\tR.TOE\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n";
}

Read<PointReader> read_trc(std::string_view text, const StreamOptions& options = {}) {
  return read_all(make_trc_reader(options, "walk.trc"), text);
}

}  // namespace

TEST_CASE("markers are read in metres, empty and nan ones are missing") {
  const auto read =
      read_trc(head("2") + "1\t0.01\t1000\t2000\t-3E2\t\t\t\t\n2\t0.02\tNaN\tnan\tNAN\t1\t2\t3\n");
  CHECK(read.error == "");
  CHECK(read.findings.empty());
  CHECK(read.header.joint_names == std::vector<std::string>{"HEAD", "R.TOE"});
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(10'000'000), utc_time(20'000'000)});
  CHECK(read.rows.state == std::vector<Tracking>{Tracking::tracked, Tracking::missing,
                                                 Tracking::missing, Tracking::tracked});
  CHECK(read.rows.positions ==
        std::vector<double>{1, 2, -300 * 0.001, 0, 0, 0, 0, 0, 0, 1 * 0.001, 2 * 0.001, 3 * 0.001});
}

TEST_CASE("a wrong number of frames in a TRC file is a finding") {
  const auto read = read_trc(head("900") + "1\t0\t1\t2\t3\t1\t2\t3\n");
  CHECK(read.rows.size() == 1);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) == "walk.trc:3: expected 900 frames, found 1");
}

TEST_CASE("a blank line ends the rows of a TRC file") {
  const auto read = read_trc(head("1") + "1\t0\t1\t2\t3\t1\t2\t3\n\nnotes\n");
  CHECK(read.rows.size() == 1);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "walk.trc: expected nothing behind the blank line that ends the rows, found 1 lines");
}

TEST_CASE("a head of a TRC file that can't be understood is an error with its line") {
  CHECK(read_trc("").error ==
        "walk.trc: expected the head of a TRC file, found the end of the file");
  CHECK(read_trc("x\n").error == "walk.trc:1: expected PathFileType, found x");
  CHECK(read_trc(head("2", "inch")).error == "walk.trc:3: expected units mm, cm or m, found inch");
  CHECK(read_trc(head("2") + "1\t0\t1\t2\t3\n").error == "walk.trc:7: expected 8 cells, found 5");
  CHECK(read_trc(head("2") + "1\tnoon\t1\t2\t3\t4\t5\t6\n").error ==
        "walk.trc:7: expected a time in seconds, found noon");
  CHECK(read_trc("PathFileType\nUnits\nm\nFrame#\tTime\tA\n\t\tX1\tY1\n").error ==
        "walk.trc:5: expected 3 labels X1, Y1, Z1, ..., found ??X1?Y1");
}

TEST_CASE("rows of a TRC file do not depend on where it is cut into pieces") {
  check_pieces([] { return make_trc_reader({}, "t"); },
               head("3") + "1\t0\t1\t2\t3\t\t\t\r\n2\t.01\t1\t2\t3\t4\t5\t6\n3\t0.02\t1");
}

TEST_CASE("OpenSim's marker files are read" * doctest::skip(!shared_data())) {
  struct Expected {
    const char* file;
    std::size_t markers, frames, findings;
  };
  for (const Expected& expected : {Expected{"walk_free_01.trc", 41, 73, 1},
                                   {"std_walking2_markers.trc", 44, 126, 0},
                                   {"dataWithBlanksForMissingMarkers.trc", 40, 464, 1},
                                   {"dataWithNaNsOfDifferentCases.trc", 14, 5, 0},
                                   {"dataWithEformat.trc", 14, 5, 0},
                                   {"exampleFormat.trc", 3, 5, 1}}) {
    CAPTURE(expected.file);
    const std::string text = shared_text(std::string("points_trc/") + expected.file);
    CHECK(looks_like_trc(text));
    const auto read = read_in_pieces(make_trc_reader({}, "a.trc"), text, 1000);
    CHECK(read.error == "");
    CHECK(read.header.joint_names.size() == expected.markers);
    CHECK(read.rows.size() == expected.frames);
    CHECK(read.findings.size() == expected.findings);
  }
  const auto read =
      read_all(make_trc_reader({}, "e.trc"), shared_text("points_trc/exampleFormat.trc"));
  CHECK(std::count(read.rows.state.begin(), read.rows.state.end(), Tracking::missing) == 2);
}
