// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ntu_skeleton.h"

#include "tests/formats/reading.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

/// A body whose joint j stands at (x + j, 1, 2), tracked.
std::string body(const std::string& id, int x) {
  std::string text = id + " 0 1 1 1 0 0 0.1 -0.2 2\n25\n";
  for (int j = 0; j < 25; ++j) {
    text += std::to_string(x + j) + " 1 2 nan 200.5 nan 500 0 0 0 0 2\n";
  }
  return text;
}

Read<PointReader> read_ntu(std::string_view text, const StreamOptions& options = {}) {
  return read_all(make_ntu_skeleton_reader(options, "S001.skeleton"), text);
}

const std::string two_people = "3\n0\n2\n" + body("72057594037931101", 0) +
                               body("72057594037931368", 100) + "1\n" +
                               body("72057594037931101", 5);

}  // namespace

TEST_CASE("the first body seen is read and the others are named") {
  const auto read = read_ntu(two_people);
  CHECK(read.error == "");
  REQUIRE(read.rows.size() == 3);
  CHECK(read.header.joint_names.size() == 25);
  CHECK(read.rows.state[0] == Tracking::missing);
  CHECK(read.rows.positions[75] == 0.0);
  CHECK(read.rows.positions[75 + 3 * 4] == 4.0);
  CHECK(read.rows.positions[150] == 5.0);
  CHECK(to_ns(read.rows.stamps[1]) == 33'333'333);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "S001.skeleton: expected one body, found several: also 72057594037931368");
}

TEST_CASE("a body is selected by its id") {
  StreamOptions options;
  options.select = {{"body", "72057594037931368"}};
  const auto read = read_ntu(two_people, options);
  CHECK(read.rows.positions[75] == 100.0);
  CHECK(read.rows.state[150 / 3] == Tracking::missing);
  CHECK(read.findings.empty());
  options.select = {{"body", "7"}};
  const auto absent = read_ntu(two_people, options);
  REQUIRE(absent.findings.size() == 1);
  CHECK(text_of(absent.findings[0]) ==
        "S001.skeleton: expected body 7, found 72057594037931101, 72057594037931368");
}

TEST_CASE("a skeleton file that ends early keeps its whole frames") {
  const std::string text = "3\n1\n" + body("7", 0) + "1\n" + body("7", 0).substr(0, 100);
  const auto read = read_ntu(text);
  CHECK(read.error == "");
  CHECK(read.rows.size() == 1);
  REQUIRE(read.findings.size() == 3);
  CHECK(text_of(read.findings[1]) ==
        "S001.skeleton:35: expected a complete frame, found the end of the file");
  CHECK(text_of(read.findings[2]) == "S001.skeleton:1: expected 3 frames, found 1");
}

TEST_CASE("what is no skeleton is an error with its line") {
  CHECK(read_ntu("").error ==
        "S001.skeleton: expected the number of frames, found the end of the file");
  CHECK(read_ntu("many\n").error == "S001.skeleton:1: expected the number of frames, found many");
  CHECK(read_ntu("1\n99999\n").error ==
        "S001.skeleton:2: expected the number of bodies, found 99999");
  CHECK(read_ntu("1\n1\n1 2 3\n").error == "S001.skeleton:3: expected 10 cells of a body, found 3");
  CHECK(read_ntu("1\n1\n7 0 1 1 1 0 0 0.1 -0.2 2\n20\n").error ==
        "S001.skeleton:4: expected 25 joints, found 20");
  CHECK(read_ntu("1\n1\n7 0 1 1 1 0 0 0.1 -0.2 2\n25\n1 2 3\n").error ==
        "S001.skeleton:5: expected 12 cells, found 3");
}

TEST_CASE("a number of the wrong kind in a skeleton file is refused with its line") {
  const std::string head = "7 0 1 1 1 0 0 0.1 -0.2 2\n";
  const auto joint = [](const std::string& state) {
    return "1 1 2 0 0 0 0 0 0 0 0 " + state + "\n";
  };
  const std::vector<std::array<std::string, 2>> refused{
      {"-1\n", "1: expected the number of frames, found -1"},
      {"18446744073709551616\n", "1: expected the number of frames, found 18446744073709551616"},
      {"1\n1.5\n", "2: expected the number of bodies, found 1.5"},
      {"1\n1\n" + head + "25 joints\n", "4: expected 25 joints, found 25 joints"},
      {"1\n1\n" + head + "26\n", "4: expected 25 joints, found 26"},
      {"1\n1\n" + head + "25\n" + joint("3"),
       "5: expected a tracking state 0, 1 or 2, found 1 1 2 0 0 0 0 0 0 0 0 3"},
      {"1\n1\n" + head + "25\n" + joint("0.5"),
       "5: expected a tracking state 0, 1 or 2, found 1 1 2 0 0 0 0 0 0 0 0 0.5"},
      {"1\n1\n" + head + "25\n" + joint("far"), "5: expected a number in column 12, found far"}};
  for (const auto& [text, message] : refused) {
    CAPTURE(text);
    CHECK(read_ntu(text).error == "S001.skeleton:" + message);
  }
}

TEST_CASE("a joint's state is the device's, and a joint without a place is missing") {
  std::string text = "1\n1\n7 0 1 1 1 0 0 0.1 -0.2 2\n25\n";
  for (int j = 0; j < 25; ++j) {
    text += (j == 4 ? "nan" : "1") + std::string(" 1 2 0 0 0 0 0 0 0 0 ") + std::to_string(j % 3) +
            "\n";
  }
  const auto read = read_ntu(text);
  CHECK(read.error == "");
  for (std::size_t j = 0; j < 25; ++j) {
    CHECK(read.rows.state[j] == (j == 4 ? Tracking::missing : static_cast<Tracking>(j % 3)));
  }
}

TEST_CASE("a promise of more frames than there are is a finding, however large") {
  const auto read = read_ntu("18446744073709551615\n1\n" + body("7", 0));
  CHECK(read.error == "");
  CHECK(read.rows.size() == 1);
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "S001.skeleton:1: expected 18446744073709551615 frames, found 1");
  CHECK(read.findings[0].meaning == "the existing frames were read");
}

TEST_CASE("a body that leaves and comes back is one stream, its absence missing joints") {
  const auto read =
      read_ntu("3\n1\n" + body("7", 0) + "1\n" + body("8", 50) + "1\n" + body("7", 9));
  REQUIRE(read.rows.size() == 3);
  CHECK(read.rows.state[0] == Tracking::tracked);
  CHECK(read.rows.state[25] == Tracking::missing);
  CHECK(read.rows.positions[75] == 0.0);
  CHECK(read.rows.positions[150] == 9.0);
  REQUIRE(!read.findings.empty());
  CHECK(text_of(read.findings[0]) == "S001.skeleton: expected one body, found several: also 8");
  CHECK(read.findings[0].meaning == "body 7, the first in the file, was read");
  CHECK(read.findings[0].repair == "to read another body, set body to its id");
}

TEST_CASE("rate, start, unit and axis of a skeleton file are the user's where given") {
  StreamOptions options;
  options.rate_hz = 15;
  options.start_ns = -1000;
  options.metres_per_unit = 0.5;
  options.up = "z";
  const auto read = read_ntu("2\n1\n" + body("7", 4) + "1\n" + body("7", 4), options);
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(-1000), utc_time(66'665'667)});
  CHECK(std::vector<double>(read.rows.positions.begin(), read.rows.positions.begin() + 3) ==
        std::vector<double>{2, 1, -0.5});
}

TEST_CASE("a skeleton file is known by its first lines") {
  CHECK(looks_like_ntu_skeleton(two_people));
  CHECK(looks_like_ntu_skeleton("3\r\n1\r\n" + body("7", 0)));
  CHECK_FALSE(looks_like_ntu_skeleton("3\n4\n5\n6\n"));
  CHECK_FALSE(looks_like_ntu_skeleton("time,x\n"));
  CHECK_FALSE(looks_like_ntu_skeleton(""));
}

TEST_CASE("frames of a skeleton file do not depend on where it is cut into pieces") {
  check_pieces([] { return make_ntu_skeleton_reader({}, "s"); }, two_people.substr(0, 3000));
}
