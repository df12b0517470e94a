// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/trc.h"

#include "tests/formats/reading.h"
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

TEST_CASE("times that are not those of the DataRate are a finding") {
  const auto said = [](const std::string& second, const std::string& third) {
    const auto read = read_trc(head("3") + "1\t0\t1\t2\t3\t1\t2\t3\n2\t" + second +
                               "\t1\t2\t3\t1\t2\t3\n3\t" + third + "\t1\t2\t3\t1\t2\t3\n");
    return read.findings.empty() ? "" : text_of(read.findings[0]);
  };
  CHECK(said("0.01", "0.02").empty());
  CHECK(said("0.0109", "0.0218").empty());
  CHECK(said("0.04", "0.08") ==
        "walk.trc:3: expected times of DataRate 100, found 25 frames per second");
}

TEST_CASE("a blank line ends the rows of a TRC file") {
  const auto read = read_trc(head("1") + "1\t0\t1\t2\t3\t1\t2\t3\n\nnotes\n");
  CHECK(read.rows.size() == 1);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "walk.trc: expected no rows after a blank line, which ends the data, found 1 lines");
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

TEST_CASE("a TRC file has its unit and its counts at its keys, or is refused") {
  const std::string rest =
      "Frame#\tTime\tHEAD\t\t\tR.TOE\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n1\t0\t1\t2\t3\t4\t5\t6\n";
  const auto with_facts = [&](const std::string& keys, const std::string& facts) {
    return read_trc("PathFileType\n" + keys + "\n" + facts + "\n" + rest);
  };
  CHECK(with_facts("NumFrames\tUnits", "many\tmm").error ==
        "walk.trc:3: expected a number of frames, found many");
  CHECK(with_facts("NumFrames\tUnit", "1\tmm").error ==
        "walk.trc:3: expected Units among the keys of line 2, found none");
  CHECK(with_facts("NumFrames\tUnits", "1").error ==
        "walk.trc:3: expected Units among the keys of line 2, found none");
  CHECK(with_facts("Units\tNumMarkers\tNumFrames", "cm\t2\t1").findings.empty());
  const auto more = with_facts("Units\tNumMarkers\tNumFrames", "cm\t9\t1");
  REQUIRE(more.findings.size() == 1);
  CHECK(text_of(more.findings[0]) == "walk.trc:4: expected 9 names of markers, found 2");
  CHECK(more.findings[0].meaning == "the named markers were read");
  CHECK(more.header.joint_names == std::vector<std::string>{"HEAD", "R.TOE"});
  CHECK(read_trc("PathFileType\nUnits\nm\nFrame\tTime\tHEAD\n").error ==
        "walk.trc:4: expected Frame#, Time and names of markers, found Frame");
  CHECK(read_trc("PathFileType\nUnits\nm\nFrame#\tTime\n").error ==
        "walk.trc:4: expected Frame#, Time and names of markers, found Frame#");
}

TEST_CASE("a TRC file's unit is a length, and the user's word on unit, axis and start wins") {
  struct Unit {
    const char* name;
    double metres;
  };
  const std::string row = "1\t2.5\t100\t200\t300\t0\t0\t0\n";
  for (const Unit& unit : {Unit{"mm", 0.001}, Unit{"cm", 0.01}, Unit{"m", 1.0}}) {
    CAPTURE(unit.name);
    const auto read = read_trc(head("1", unit.name) + row);
    CHECK(read.rows.positions ==
          std::vector<double>{100 * unit.metres, 200 * unit.metres, 300 * unit.metres, 0, 0, 0});
  }
  StreamOptions options;
  options.up = "z";
  options.metres_per_unit = 2;
  options.start_ns = 77;
  const auto read = read_trc(head("2") + row + "2\t2.75\t1\t2\t3\t4\t5\t6\n", options);
  CHECK(read.rows.positions == std::vector<double>{200, 600, -400, 0, 0, 0, 2, 6, -4, 8, 12, -10});
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(77), utc_time(250'000'077)});
}

TEST_CASE("a marker with one missing number is dropped") {
  const auto read = read_trc(head("1") + "1\t0\t1\t\t3\t4\t5\tnan\n");
  CHECK(read.rows.state == std::vector<Tracking>{Tracking::missing, Tracking::missing});
  CHECK(read.rows.positions == std::vector<double>(6, 0.0));
}

TEST_CASE("a TRC file that was cut off ends with its last whole line") {
  const std::string row = "1\t0\t1\t2\t3\t4\t5\t6\n";
  const auto cut = read_trc(head("2") + row + "2\t0.01\t1\t2");
  CHECK(cut.error == "");
  CHECK(cut.rows.size() == 1);
  REQUIRE(cut.findings.size() == 2);
  CHECK(text_of(cut.findings[0]) == "walk.trc:8: expected 8 cells, found 4");
  CHECK(cut.findings[0].meaning == "the last line is incomplete and was dropped");
  CHECK(text_of(cut.findings[1]) == "walk.trc:3: expected 2 frames, found 1");
  const auto unsure = read_trc(head("1") + row.substr(0, row.size() - 1));
  CHECK(unsure.rows.size() == 1);
  REQUIRE(unsure.findings.size() == 1);
  CHECK(text_of(unsure.findings[0]) ==
        "walk.trc:7: expected a line end after the last value, found the end of the file");
}

TEST_CASE("a TRC file with constant time is reported, and stamped by a known rate") {
  std::string text = head("3");
  for (int i = 1; i <= 3; ++i) text += std::to_string(i) + "\t4\t1\t2\t3\t4\t5\t6\n";
  const auto stuck = read_trc(text);
  REQUIRE(stuck.findings.size() == 1);
  CHECK(text_of(stuck.findings[0]) ==
        "walk.trc: expected stamps that change, found the same stamp in the first 3 rows");
  StreamOptions options;
  options.rate_hz = 100;
  CHECK(read_trc(text, options).rows.stamps == std::vector<Time>{utc_time(4'000'000'000),
                                                                 utc_time(4'010'000'000),
                                                                 utc_time(4'020'000'000)});
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
                                   {"std_walking2_markers.trc", 44, 126, 1},
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
