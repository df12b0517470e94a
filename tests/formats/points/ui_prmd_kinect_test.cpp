// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/points/ui_prmd_kinect.h"

#include "tests/formats/reading.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

/// A row of 66 numbers: `first` holds three of them, all others are `rest`.
std::string row(const std::string& first, const std::string& rest) {
  std::string text = first;
  for (int i = 3; i < 66; ++i) text += "," + rest;
  return text + "\n";
}

TextPieces in_pieces(std::string text, std::size_t piece) {
  return
      [text = std::move(text), piece, at = std::size_t{0}]() mutable -> Result<std::string_view> {
        const auto part = std::string_view(text).substr(std::min(at, text.size()), piece);
        at += part.size();
        return part;
      };
}

Read<PointReader> read_pair(const std::string& offsets, std::string angles) {
  return read_all(make_ui_prmd_kinect_reader({}, "p.txt", "a.txt", in_pieces(std::move(angles), 7)),
                  offsets);
}

}  // namespace

TEST_CASE("offsets and angles become places") {
  // The root is turned by 90 degrees about z, so every offset (1, 1, 1) cm becomes (-1, 1, 1). Then
  // all is turned by half a turn about y, because the files' z points to the camera.
  const auto read = read_pair(row("10,20,-300", "1"), row("0,0,90", "0"));
  CHECK(read.error == "");
  REQUIRE(read.rows.size() == 1);
  const auto place = [&](std::size_t j) {
    return Vec3(vec3(std::span<const double>(read.rows.positions), j));
  };
  CHECK((place(0) - Vec3(-0.10, 0.20, 3.00)).norm() < 1e-12);
  CHECK((place(1) - Vec3(-0.09, 0.21, 2.99)).norm() < 1e-12);
  CHECK((place(5) - Vec3(-0.05, 0.25, 2.95)).norm() < 1e-12);
  CHECK(read.header.joint_names[21] == "ToesRight");
}

TEST_CASE("rows without a counterpart are dropped with a finding") {
  const std::string one = row("1,2,3", "1");
  const auto longer = read_pair(one + one, one);
  CHECK(longer.rows.size() == 1);
  REQUIRE(longer.findings.size() == 1);
  CHECK(text_of(longer.findings[0]) == "p.txt: expected as many rows as in a.txt, found 1 more");
  const auto shorter = read_pair(one, one + one + one);
  REQUIRE(shorter.findings.size() == 1);
  CHECK(text_of(shorter.findings[0]) == "a.txt: expected as many rows as in p.txt, found 2 more");
  CHECK(read_pair(one, "1,2\n").error == "a.txt:1: expected 66 cells, found 2");
  CHECK(read_pair("1,2\n", one).error == "p.txt:1: expected 66 cells, found 2");
  CHECK(read_pair("", one).error ==
        "p.txt: expected rows of 66 numbers, found the end of the file");
}

TEST_CASE("an empty cell of either file of UI-PRMD is refused with its line") {
  const std::string one = row("1,2,3", "1");
  CHECK(read_pair(one + row("1,,3", "1"), one + one).error ==
        "p.txt:2: expected 66 offsets, found an empty cell");
  CHECK(read_pair(one + one, one + row("1,nan,3", "1")).error ==
        "a.txt:2: expected 66 angles, found an empty cell");
  CHECK(read_pair(row("x,2,3", "1"), one).error ==
        "p.txt:1: expected a number in column 1, found x");
  CHECK(read_pair(one, row("1,2,3", "y")).error ==
        "a.txt:1: expected a number in column 4, found y");
}

TEST_CASE("a fault behind the last offset is one of the angles' file all the same") {
  const std::string one = row("1,2,3", "1");
  CHECK(read_pair(one, one + "1,2\n" + one).error == "a.txt:2: expected 66 cells, found 2");
}

TEST_CASE("rate, start, unit and axis of UI-PRMD's files are the user's where given") {
  StreamOptions options;
  options.rate_hz = 10;
  options.start_ns = 5;
  options.metres_per_unit = 2;
  options.up = "z";
  const std::string one = row("1,2,3", "0");
  const auto read = read_all(
      make_ui_prmd_kinect_reader(options, "p.txt", "a.txt", in_pieces(one + one, 9)), one + one);
  CHECK(read.rows.stamps == std::vector<Time>{utc_time(5), utc_time(100'000'005)});
  CHECK(Vec3(read.rows.positions.data()) == Vec3(-2, -6, -4));
  const auto usual = read_pair(one + one, one + one);
  CHECK(usual.rows.stamps == std::vector<Time>{utc_time(0), utc_time(33'333'333)});
  CHECK(Vec3(usual.rows.positions.data()) == Vec3(-0.01, 0.02, -0.03));
}

TEST_CASE("each joint turns all that hang on it and nothing else") {
  const std::vector<std::vector<std::string>> chains{
      {"Waist", "Spine", "Chest", "Neck", "Head", "HeadTip"},
      {"Waist", "Spine", "Chest", "CollarLeft", "UpperArmLeft", "ForearmLeft", "HandLeft"},
      {"Waist", "Spine", "Chest", "CollarRight", "UpperArmRight", "ForearmRight", "HandRight"},
      {"Waist", "UpperLegLeft", "LowerLegLeft", "FootLeft", "ToesLeft"},
      {"Waist", "UpperLegRight", "LowerLegRight", "FootRight", "ToesRight"}};
  const std::string one = row("1,0,0", "1");
  const auto names = read_pair(one, one).header.joint_names;
  REQUIRE(names.size() == 22);
  std::vector<double> offsets(66, 0.0), straight(66), turned(66);
  for (std::size_t j = 0; j < 22; ++j) offsets[3 * j] = 1.0;  // along x
  ui_prmd_places(offsets, std::vector<double>(66, 0.0), straight);
  for (std::size_t j = 0; j < 22; ++j) {
    CAPTURE(names[j]);
    std::vector<double> angles(66, 0.0);
    angles[3 * j + 2] = 90.0;  // about z
    ui_prmd_places(offsets, angles, turned);
    std::set<std::string> moved, behind;
    for (std::size_t k = 0; k < 22; ++k) {
      const Vec3 apart =
          vec3(std::span<const double>(turned), k) - vec3(std::span<const double>(straight), k);
      if (apart.norm() > 0.1) moved.insert(names[k]);
    }
    for (const auto& chain : chains) {
      const auto at = std::find(chain.begin(), chain.end(), names[j]);
      if (at != chain.end()) behind.insert(at + 1, chain.end());
    }
    CHECK(moved == behind);
  }
}

TEST_CASE("places do not depend on where the offsets are cut into pieces") {
  const std::string one = row("1,2,3", "4");
  check_pieces([&] { return make_ui_prmd_kinect_reader({}, "p", "a", in_pieces(one + one, 5)); },
               one + one);
}

TEST_CASE("UI-PRMD's Kinect joints are where its own kinematics puts them" *
          doctest::skip(!shared_data())) {
  const std::string folder = "ui_prmd/original/Kinect/";
  const std::string offsets = shared_text(folder + "Positions/m02_s01_e01_positions.txt");
  const std::string angles = shared_text(folder + "Angles/m02_s01_e01_angles.txt");
  CHECK(looks_like_ui_prmd_kinect(offsets.substr(0, 4096)));
  const auto read = read_in_pieces(
      make_ui_prmd_kinect_reader({}, "p", "a", in_pieces(angles, 5000)), offsets, 4096);
  CHECK(read.error == "");
  CHECK(read.findings.empty());
  CHECK(read.rows.size() == 62);
  // NumPy 1.24.2, R = Rz Rx Ry, then half a turn about y; row 10, cm: HeadTip, HandLeft, FootRight
  const auto near = [&](std::size_t joint, const Vec3& cm) {
    const Vec3 place = vec3(std::span<const double>(read.rows.positions), 10 * 22 + joint);
    return (place * 100 - cm).norm() < 1e-4;
  };
  CHECK(near(5, Vec3(6.16244, 156.18808, 226.07921)));
  CHECK(near(9, Vec3(-40.34596, 135.40009, 228.47968)));
  CHECK(near(20, Vec3(10.39412, 8.88246, 233.73077)));
}
