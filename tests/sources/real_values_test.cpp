// SPDX-License-Identifier: Apache-2.0
// Every number of real recordings compared with a plain reading of the same text in Python.
#include "tests/formats/reading.h"
#include "tests/shared_data.h"
#include "tests/witness.h"

#include "kinalign/formats/imu/opensim_sto.h"
#include "kinalign/formats/imu/xsens_text.h"
#include "kinalign/formats/points/trc.h"
#include "kinalign/formats/table/table_reader.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>

using namespace kinalign;

namespace {

/// How a file is read, by us and by the script, and its path below ../shared/data.
struct File {
  const char* way;
  const char* path;
};

/// The values that the witness script real_values.py read from the file of the given number.
class Witnessed {
 public:
  Witnessed(const FreshFolder& folder, std::size_t file) : folder_(folder), file_(file) {}

  std::vector<double> numbers(const std::string& name) const {
    const std::string bytes = folder_.read(std::to_string(file_) + "_" + name + ".out");
    std::vector<double> out(bytes.size() / sizeof(double));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }

 private:
  const FreshFolder& folder_;
  std::size_t file_;
};

void ask_witness(const FreshFolder& folder, std::span<const File> files) {
  std::string list;
  for (const File& file : files)
    list += std::string(file.way) + "\t" + shared_path(file.path) + "\n";
  folder.write("files.txt", list);
  REQUIRE(run_witness("real_values.py", folder.path()) == 0);
}

void check_stamps(const std::vector<Time>& ours, const Witnessed& found) {
  const std::vector<double> theirs = found.numbers("stamps");
  REQUIRE(2 * ours.size() == theirs.size());
  std::size_t wrong = 0;
  for (std::size_t t = 0; t < ours.size(); ++t) {
    const auto ns = static_cast<std::int64_t>(theirs[2 * t]) * 1'000'000'000 +
                    static_cast<std::int64_t>(theirs[2 * t + 1]);
    wrong += std::abs(to_ns(ours[t]) - ns) <= 1 ? 0 : 1;  // a half is rounded either way
  }
  CHECK(wrong == 0);
}

/// Compares rows of `width` numbers; `there`: the rows that hold something by our reading.
template <class There>
void check_numbers(std::span<const double> ours, std::size_t width, const Witnessed& found,
                   const std::string& name, There there) {
  CAPTURE(name);
  const std::vector<double> theirs = found.numbers(name);
  REQUIRE(ours.size() == theirs.size());
  std::size_t wrong = 0;
  for (std::size_t row = 0; row < ours.size() / width; ++row) {
    // A quaternion and its negative are one rotation, so either may be written.
    double straight = 0.0, opposite = 0.0;
    bool known = true;
    for (std::size_t k = row * width; k < (row + 1) * width; ++k) {
      straight = std::max(straight, std::abs(ours[k] - theirs[k]));
      opposite = std::max(opposite, std::abs(ours[k] + theirs[k]));
      known = known && !std::isnan(theirs[k]);
    }
    const bool same = straight < 1e-12 || (width == 4 && opposite < 1e-12);
    wrong += there(row) == known && (!known || same) ? 0 : 1;
  }
  CHECK(wrong == 0);
}

void check_points(const PointFrames& rows, const Witnessed& found) {
  check_stamps(rows.stamps, found);
  check_numbers(rows.positions, 3, found, "positions",
                [&](std::size_t cell) { return rows.state[cell] != Tracking::missing; });
}

void check_nodes(const Read<ImuReader>& read, const Witnessed& found) {
  const ImuSamples& rows = read.rows;
  const auto there = [&](std::size_t cell) { return rows.valid[cell] != 0; };
  check_stamps(rows.stamps, found);
  const ImuContent& content = read.header.content;
  if (content.orientation) check_numbers(rows.orientation, 4, found, "orientation", there);
  if (content.acceleration) check_numbers(rows.acceleration, 3, found, "acceleration", there);
  if (content.angular_velocity) {
    check_numbers(rows.angular_velocity, 3, found, "angular_velocity", there);
  }
}

}  // namespace

TEST_CASE("every point of real recordings is where a plain reading has it" *
          doctest::skip(!shared_data())) {
  constexpr File files[] = {
      {"keraal_kinect", "kinect_keraal/G3-Kinect-CTK-P1T1-Unknown-C-0.txt"},
      {"keraal_kinect", "kinect_keraal/G3-Kinect-ELK-P1T1-Unknown-C-0.txt"},
      {"keraal_vicon", "kinect_keraal/G3-Vicon-CTK-P1T1-Unknown-C-0.txt"},
      {"kinect_laban", "kinect_laban/joints.csv"},
      {"kinect_laban", "kinect_laban/Ges01_wavehand.csv"},
      {"kinect2_phone_skip", "imu_pose/kinect2_phone_skip/kinect_joints.csv"},
      {"ui_prmd_vicon", "ui_prmd/original/Vicon/Positions/m02_s01_e01_positions.txt"},
      {"unsw_vicon", "imu_pose/unsw_walk/vicon_S02-Trial-Walk-1.csv"},
      {"trc", "points_trc/walk_free_01.trc"},
      {"trc", "points_trc/std_walking2_markers.trc"},
      {"trc", "points_trc/dataWithBlanksForMissingMarkers.trc"},
      {"trc", "points_trc/exampleFormat.trc"}};
  const FreshFolder folder;
  ask_witness(folder, files);
  for (std::size_t i = 0; i < std::size(files); ++i) {
    CAPTURE(files[i].path);
    const bool trc = files[i].way == std::string("trc");
    auto reader = trc ? make_trc_reader({}, files[i].path)
                      : make_point_table_reader(builtin(files[i].way), {}, files[i].path);
    const auto read = read_in_pieces(std::move(reader), shared_text(files[i].path), 4096);
    CHECK(read.error == "");
    check_points(read.rows, {folder, i});
  }
}

TEST_CASE("every sample of real nodes is what a plain reading has" *
          doctest::skip(!shared_data())) {
  constexpr File files[] = {
      {"unsw_imu", "imu_pose/unsw_walk/imu/S02-Trial-Walk-1-Pelvis.csv"},
      {"sto", "imu_opensim/opensense/imuOrientations.sto"},
      {"sto",
       "imu_opensim/opensense/MT_012005D6_009-quaternions_calibration_trial_Facing_negX.sto"},
      {"xsens", "imu_pose/unsw_walk/rawimu/S02-Trial-Walk-1-000_00B40B91.txt"}};
  const FreshFolder folder;
  ask_witness(folder, files);
  for (std::size_t i = 0; i < std::size(files); ++i) {
    CAPTURE(files[i].path);
    const std::string way = files[i].way, path = files[i].path;
    auto reader = way == "sto"     ? make_opensim_sto_reader({}, path)
                  : way == "xsens" ? make_xsens_text_reader({}, path, "node")
                                   : make_imu_table_reader(builtin(way), {}, path, "node");
    const auto read = read_in_pieces(std::move(reader), shared_text(path), 4096);
    CHECK(read.error == "");
    check_nodes(read, {folder, i});
  }
}
