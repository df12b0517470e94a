// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/imu/opensim_sto.h"

#include "tests/formats/reading.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

const std::string head =
    "\nDataRate=100.000000\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.1\n endheader \n"
    "time\ttorso_imu\tpelvis_imu\n";

Read<ImuReader> read_sto(std::string_view text, const StreamOptions& options = {}) {
  return read_all(make_opensim_sto_reader(options, "a.sto"), text);
}

}  // namespace

TEST_CASE("a .sto file gives the nodes' orientations, z up turned to y up") {
  const auto read = read_sto(head + "678\t1,0,0,0\t0.5,0.5,0.5,0.5\n678.01\tnan\t1,0,0,0\n");
  CHECK(read.error == "");
  CHECK(read.header.node_names == std::vector<std::string>{"torso_imu", "pelvis_imu"});
  CHECK(read.header.content == ImuContent{true, false, false, true});
  CHECK(read.rows.stamps ==
        std::vector<Time>{utc_time(678'000'000'000), utc_time(678'010'000'000)});
  CHECK(read.rows.valid == std::vector<std::uint8_t>{1, 1, 0, 1});
  CHECK((quat(read.rows.orientation, 0) * Vec3(0, 0, 1) - Vec3(0, 1, 0)).norm() < 1e-15);
  StreamOptions options;
  options.up = "y";
  options.start_ns = 5;
  const auto upright = read_sto(head + "678\t1,0,0,0\t1,0,0,0\n", options);
  CHECK(upright.rows.orientation == std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0});
  CHECK(upright.rows.stamps[0] == utc_time(5));
}

TEST_CASE("a .sto file of other things is an error") {
  CHECK(read_sto("DataType=Vec3\nendheader\n").error ==
        "a.sto:1: expected DataType=Quaternion, found Vec3");
  CHECK(read_sto("version=3\nendheader\n").error ==
        "a.sto:2: expected DataType=Quaternion in the head, found none");
  CHECK(read_sto("").error == "a.sto: expected the head of a .sto file, found the end of the file");
  CHECK(read_sto(head + "1\t1,0,0,0\n").error == "a.sto:8: expected 3 cells, found 2");
  CHECK(read_sto(head + "1\t1,0,0\t1,0,0,0\n").error ==
        "a.sto:8: expected w,x,y,z for torso_imu, found 1,0,0");
}

TEST_CASE("names and stamps of a .sto file are refused where they are none") {
  const std::string begin = "DataType=Quaternion\nendheader\n";
  const std::vector<std::array<std::string, 2>> refused{
      {begin + "seconds\ta_imu\n", "a.sto:3: expected time and names of nodes, found seconds"},
      {begin + "time\n", "a.sto:3: expected time and names of nodes, found time"},
      {begin + "\t\n" + "time\ta_imu\nnoon\t1,0,0,0\n",
       "a.sto:5: expected a time in seconds, found noon"},
      {begin + "time\ta_imu\n5e9\t1,0,0,0\n", "a.sto:4: expected a time in seconds, found 5e9"},
      {begin + "time\ta_imu\n1\t1,0,0,0,0\n",
       "a.sto:4: expected w,x,y,z for a_imu, found 1,0,0,0,0"},
      {begin + "time\ta_imu\n1\t1,0,0,x\n", "a.sto:4: expected w,x,y,z for a_imu, found 1,0,0,x"},
      {begin, "a.sto:2: expected the head of a .sto file, found the end of the file"}};
  for (const auto& [text, message] : refused) {
    CAPTURE(text);
    CHECK(read_sto(text).error == message);
  }
}

TEST_CASE("a node without an orientation in a row is invalid there, the others are not") {
  const auto read = read_sto(head + "1\t\t1,0,0,0\n2\t1,,0,0\t1,0,0,0\n3\t0,0,0,0\t1,0,0,0\n");
  CHECK(read.error == "");
  CHECK(read.rows.valid == std::vector<std::uint8_t>{0, 1, 0, 1, 0, 1});
  REQUIRE(read.findings.size() == 1);
  CHECK(read.findings[0].severity == Severity::note);
  CHECK(text_of(read.findings[0]) ==
        "a.sto: expected quaternions of length 1, found 1 of 6 samples with length 0");
  CHECK(read.findings[0].meaning == "these samples are invalid");
}

TEST_CASE("quaternions of another length are brought to 1, with a finding from two percent on") {
  const auto read = read_sto(head + "1\t2,0,0,0\t1.019,0,0,0\n2\t0,0.97,0,0\t0,0,0,1e-7\n");
  REQUIRE(read.findings.size() == 2);
  CHECK(read.findings[1].severity == Severity::warning);
  CHECK(
      text_of(read.findings[1]) ==
      "a.sto: expected quaternions of length 1, found 2 of 4 samples that differ by more than 2 %");
  CHECK(read.findings[1].meaning == "these quaternions were normalised");
  CHECK(read.findings[1].repair == "check the columns in the layout");
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    CHECK(quat(read.rows.orientation, i).norm() == doctest::Approx(1.0).epsilon(1e-15));
  }
  CHECK(read.rows.valid == std::vector<std::uint8_t>{1, 1, 1, 0});
}

TEST_CASE("rows of a .sto file do not depend on where it is cut into pieces") {
  check_pieces([] { return make_opensim_sto_reader({}, "s"); },
               head + "678\t1,0,0,0\t0.5,0.5,0.5,0.5\r\n678.01\t\t1,0,0,0\n679\t1,0");
}

TEST_CASE("OpenSense's orientation files are read" * doctest::skip(!shared_data())) {
  struct Expected {
    const char* file;
    std::size_t nodes, rows;
  };
  for (const Expected& expected :
       {Expected{"MT_012005D6_009-quaternions_calibration_trial_Facing_negX.sto", 8, 401},
        {"imuOrientations.sto", 8, 2},
        {"myComplexTasksTrial_orientations.sto", 7, 6}}) {
    CAPTURE(expected.file);
    const std::string text = shared_text(std::string("imu_opensim/opensense/") + expected.file);
    CHECK(looks_like_opensim_sto(text.substr(0, 4096)));
    const auto read = read_in_pieces(make_opensim_sto_reader({}, "a.sto"), text, 777);
    CHECK(read.error == "");
    CHECK(read.header.node_names.size() == expected.nodes);
    CHECK(read.rows.size() == expected.rows);
    CHECK(read.findings.empty());
  }
}
