// SPDX-License-Identifier: Apache-2.0
// The built-in layouts on the recordings for which they were made; the expected numbers are those
// of the recordings' own description.
#include "tests/formats/reading.h"
#include "tests/shared_data.h"

#include "kinalign/formats/table/table_reader.h"
#include "kinalign/motion/stamps.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

using namespace kinalign;

namespace {

Read<PointReader> read_points(std::string_view layout, const std::string& path,
                              const StreamOptions& options = {}) {
  const std::string text = shared_text(path);
  CHECK(matches(builtin(layout), std::string_view(text).substr(0, 4096)));
  auto read = read_in_pieces(make_point_table_reader(builtin(layout), options, path), text, 65'536);
  CHECK(read.error == "");
  return read;
}

double share(const PointFrames& rows, Tracking state) {
  const auto count = std::count(rows.state.begin(), rows.state.end(), state);
  return static_cast<double>(count) / static_cast<double>(rows.state.size());
}

StampSurvey survey(const std::vector<Time>& stamps) {
  StampSurveyor surveyor;
  surveyor.add(stamps);
  return surveyor.result();
}

/// Mean of a joint's coordinate, m.
double mean(const Read<PointReader>& read, std::string_view joint, std::size_t axis) {
  const auto& names = read.header.joint_names;
  const auto j =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), joint) - names.begin());
  double sum = 0.0;
  for (std::size_t t = 0; t < read.rows.size(); ++t) {
    sum += read.rows.positions[3 * (t * names.size() + j) + axis];
  }
  return sum / static_cast<double>(read.rows.size());
}

}  // namespace

TEST_CASE("the Laban recorder's Kinect files are read" * doctest::skip(!shared_data())) {
  struct Expected {
    const char* file;
    std::size_t frames;
    double inferred;
  };
  for (const Expected& expected : {Expected{"joints.csv", 371, 0.318},
                                   {"Ges01_wavehand.csv", 154, 0.003},
                                   {"Ges04_comehere.csv", 172, 0.002}}) {
    CAPTURE(expected.file);
    const auto read = read_points("kinect_laban", std::string("kinect_laban/") + expected.file);
    CHECK(read.rows.size() == expected.frames);
    CHECK(read.header.joint_names.size() == 25);
    CHECK(std::abs(share(read.rows, Tracking::inferred) - expected.inferred) < 0.0005);
    CHECK(std::abs(static_cast<double>(survey(read.rows.stamps).median_step_ns) - 33.0e6) <
          0.33e6);  // the survey knows the rate to 1 percent
  }
}

TEST_CASE("Keraal's Kinect and optical files are read" * doctest::skip(!shared_data())) {
  for (const auto& [name, kinect, vicon] : {std::tuple{"CTK", 197U, 390U}, {"ELK", 193U, 385U}}) {
    const std::string end = std::string(name) + "-P1T1-Unknown-C-0.txt";
    const auto joints = read_points("keraal_kinect", "kinect_keraal/G3-Kinect-" + end);
    CHECK(joints.rows.size() == kinect);
    CHECK(joints.findings.empty());
    const auto targets = read_points("keraal_vicon", "kinect_keraal/G3-Vicon-" + end);
    CHECK(targets.rows.size() == vicon);
    CHECK(mean(targets, "Head", 1) > mean(targets, "LFoot", 1) + 1.0);  // y is up, metres
    CHECK(share(targets.rows, Tracking::tracked) == 1.0);
  }
}

TEST_CASE("two Kinects of one log are taken apart" * doctest::skip(!shared_data())) {
  const std::string path = "kinect_multitrack/Study_10_Kinect_0_Time_4_06_33_PM_trim.csv";
  StreamOptions options;
  options.select = {{"Skeleton#", "0"}};
  const auto first = read_points("kinect_multitrack", path, options);
  options.select = {{"Skeleton#", "1"}};
  const auto second = read_points("kinect_multitrack", path, options);
  CHECK(first.rows.size() + second.rows.size() == 600);
  CHECK(first.rows.stamps[0] == second.rows.stamps[0]);
  CHECK(first.rows.stamps[0] == utc_time(1'426'608'447'984'000'000));
  CHECK(mean(first, "Head", 1) > mean(first, "FootLeft", 1) + 1.4);
  CHECK(first.findings.empty());
  options.select = {{"Kinect#", "138.251.207.136"}};
  CHECK(read_points("kinect_multitrack", path, options).rows.stamps == second.rows.stamps);
}

TEST_CASE("a Kinect next to a phone is read, also frames without a body" *
          doctest::skip(!shared_data())) {
  const auto read =
      read_points("kinect2_phone_skip", "imu_pose/kinect2_phone_skip/kinect_joints.csv");
  CHECK(read.rows.size() == 360);
  const auto seen = std::find_if(read.rows.state.begin(), read.rows.state.end(),
                                 [](Tracking state) { return state != Tracking::missing; });
  CHECK((seen - read.rows.state.begin()) / 25 == 16);
  CHECK(to_ns(read.rows.stamps[0]) == 1'642'700'852'075'903'000);
  CHECK(std::abs(static_cast<double>(survey(read.rows.stamps).median_step_ns) - 33.1e6) < 0.4e6);
}

TEST_CASE("UI-PRMD's markers are read" * doctest::skip(!shared_data())) {
  const auto read =
      read_points("ui_prmd_vicon", "ui_prmd/original/Vicon/Positions/m02_s01_e01_positions.txt");
  CHECK(read.header.joint_names.size() == 39);
  CHECK(mean(read, "LFHD", 1) > 1.4);
  CHECK(mean(read, "LTOE", 1) < 0.2);
}

TEST_CASE("UNSW's sensors and joint centres are read, gravity up" * doctest::skip(!shared_data())) {
  const auto points = read_points("unsw_vicon", "imu_pose/unsw_walk/vicon_S02-Trial-Walk-1.csv");
  CHECK(points.rows.size() == 955);
  CHECK(mean(points, "PELV", 1) > 0.9);
  const std::string path = "imu_pose/unsw_walk/imu/S02-Trial-Walk-1-Pelvis.csv";
  const std::string text = shared_text(path);
  CHECK(matches(builtin("unsw_imu"), text.substr(0, 4096)));
  const auto imu = read_all(make_imu_table_reader(builtin("unsw_imu"), {}, path, "waist"), text);
  CHECK(imu.error == "");
  REQUIRE(imu.rows.size() == 955);
  CHECK(imu.header.content == ImuContent{true, true, true, true});
  CHECK(imu.rows.stamps[954] == utc_time(9'540'000'000));
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t < 955; ++t) {
    sum += quat(imu.rows.orientation, t) *
           Vec3(vec3(std::span<const double>(imu.rows.acceleration), t));
  }
  CHECK((sum / 955 - Vec3(0.06, 9.90, 0.09)).norm() < 0.01);
}

TEST_CASE("a recording is taken for no other layout than its own" * doctest::skip(!shared_data())) {
  const std::vector<std::pair<const char*, const char*>> files{
      {"kinect_laban/joints.csv", "kinect_laban"},
      {"kinect_keraal/G3-Kinect-CTK-P1T1-Unknown-C-0.txt", "keraal_kinect"},
      {"kinect_keraal/G3-Vicon-CTK-P1T1-Unknown-C-0.txt", "keraal_vicon"},
      {"kinect_multitrack/Study_10_Kinect_0_Time_4_06_33_PM_trim.csv", "kinect_multitrack"},
      {"imu_pose/kinect2_phone_skip/kinect_joints.csv", "kinect2_phone_skip"},
      {"ui_prmd/original/Vicon/Positions/m02_s01_e01_positions.txt", "ui_prmd_vicon"},
      {"imu_pose/unsw_walk/imu/S02-Trial-Walk-1-Pelvis.csv", "unsw_imu"},
      {"imu_pose/unsw_walk/vicon_S02-Trial-Walk-1.csv", "unsw_vicon"}};
  for (const auto& [file, own] : files) {
    const std::string begin = shared_text(file).substr(0, 4096);
    for (const std::string_view name : builtin_layout_names()) {
      CAPTURE(file);
      CAPTURE(name);
      CHECK(matches(builtin(name), begin) == (name == own));
    }
  }
}
