// SPDX-License-Identifier: Apache-2.0
// Real recordings of other people, aligned as a user would align them. The expected figures were
// computed in NumPy by the collectors of ../shared/data and are in its README.
#include "tests/folder.h"
#include "tests/shared_data.h"

#include "kinalign/align/align.h"
#include "kinalign/formats/table/layout.h"
#include "kinalign/motion/arrivals.h"
#include "kinalign/sources/open_recording.h"

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

using namespace kinalign;

namespace {

StreamOptions stream(const std::string& name, const std::string& path, const std::string& layout) {
  StreamOptions out;
  out.name = name;
  out.files = {{path, ""}};
  out.layout = layout;
  return out;
}

Result<Take> aligned(const Manifest& manifest) {
  PosixFiles files;
  const Recording recording = KA_TRY(open_recording(files, manifest, ""));
  return align(recording, manifest);
}

Manifest keraal(const std::string& exercise, double lag_ms) {
  const std::string folder = shared_path("kinect_keraal/");
  const std::string rest = exercise + "-P1T1-Unknown-C-0.txt";
  Manifest manifest;
  manifest.streams = {stream("optical", folder + "G3-Vicon-" + rest, "keraal_vicon"),
                      stream("kinect", folder + "G3-Kinect-" + rest, "keraal_kinect")};
  manifest.streams[0].rate_hz = 60.0;
  manifest.streams[1].rate_hz = 30.0;
  manifest.streams[1].offset_ms = lag_ms;
  SpaceOptions& space = manifest.spaces["kinect"];
  space.method = "fit";
  space.joints = {{"SpineBase", "Hips"},         {"Head", "Head"},
                  {"HandLeft", "LHand"},         {"HandRight", "RHand"},
                  {"FootLeft", "LFoot"},         {"FootRight", "RFoot"},
                  {"ShoulderLeft", "LShoulder"}, {"ShoulderRight", "RShoulder"}};
  return manifest;
}

Manifest two_kinects(const std::string& path, int scenario) {
  Manifest manifest;
  for (const std::string skeleton : {"0", "1"}) {
    StreamOptions kinect = stream("kinect_" + skeleton, path, "kinect_multitrack");
    kinect.select = {{"Skeleton#", skeleton}, {"Scenario", std::to_string(scenario)}};
    kinect.clock = "shared";
    manifest.streams.push_back(kinect);
  }
  manifest.spaces["kinect_1"].method = "fit";
  return manifest;
}

void unpack_multitrack(const FreshFolder& into) {
  const std::string unpack =
      "/usr/bin/python3 " + shared_path("unpack.py") + " multitrack '" + into.path() + "'";
  REQUIRE(std::system(unpack.c_str()) == 0);
}

/// The stamps of the first body's rows, ns, as a layout reads them.
std::vector<std::int64_t> stamps_by(const std::string& layout, const std::string& path) {
  Manifest manifest;
  manifest.streams = {stream("kinect", path, layout)};
  manifest.streams[0].select = {{"Skeleton#", "0"}};
  PosixFiles files;
  const auto recording = open_recording(files, manifest, "");
  REQUIRE(recording);
  const auto pass = std::get<PointInput>(recording->streams[0].data).passes();
  REQUIRE(pass);
  std::vector<std::int64_t> out;
  PointFrames block;
  while (*(*pass)(block)) {
    for (const Time stamp : block.stamps) out.push_back(to_ns(stamp));
  }
  return out;
}

/// Root mean square angle, degrees, that remains between two lists after the best constant
/// rotations on both sides, found by plain alternation of eigenvector means.
double constant_rotations_leave(const std::vector<Quat>& a, const std::vector<Quat>& b) {
  Quat left = Quat::Identity(), right = Quat::Identity();
  const auto mean = [](const std::vector<Quat>& all) {
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (const Quat& q : all) sum += q.coeffs() * q.coeffs().transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
    return Quat(Eigen::Vector4d(solver.eigenvectors().col(3)));
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<Quat> rights, lefts;
    for (std::size_t i = 0; i < a.size(); ++i) rights.push_back((left * a[i]).conjugate() * b[i]);
    right = mean(rights);
    for (std::size_t i = 0; i < a.size(); ++i) lefts.push_back(b[i] * (a[i] * right).conjugate());
    left = mean(lefts);
  }
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double angle = (left * a[i] * right).angularDistance(b[i]);
    square += angle * angle;
  }
  return std::sqrt(square / static_cast<double>(a.size())) * 180.0 / std::numbers::pi;
}

/// Columns of a CSV with `//` lines above its header, by name.
std::map<std::string, std::vector<double>> columns(const std::string& text) {
  std::istringstream lines(text);
  std::string line, cell;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> out;
  while (std::getline(lines, line)) {
    if (line.starts_with("//")) continue;
    if (line.ends_with('\r')) line.pop_back();
    std::istringstream cells(line);
    if (names.empty()) {
      while (std::getline(cells, cell, ',')) names.push_back(cell);
      continue;
    }
    for (const std::string& name : names) {
      std::getline(cells, cell, ',');
      out[name].push_back(std::stod(cell));
    }
  }
  return out;
}

std::vector<Quat> rotations(const std::map<std::string, std::vector<double>>& columns,
                            const std::string& name) {
  std::vector<Quat> out;
  for (std::size_t i = 0; i < columns.at(name + "_1").size(); ++i) {
    out.emplace_back(columns.at(name + "_1")[i], columns.at(name + "_2")[i],
                     columns.at(name + "_3")[i], columns.at(name + "_4")[i]);
  }
  return out;
}

}  // namespace

TEST_CASE("Keraal: a Kinect onto optical points, and the report shows the joints to blame" *
          doctest::skip(!shared_data())) {
  const auto calm = aligned(keraal("CTK", 0.0));
  REQUIRE(calm);
  CHECK(std::abs(100.0 * calm->report.spaces.at(0).after_m - 7.6) <= 0.2);

  const auto lost = aligned(keraal("ELK", -20.0));
  REQUIRE(lost);
  const SpaceReport& space = lost->report.spaces.at(0);
  CHECK(std::abs(100.0 * space.after_m - 20.8) <= 0.2);
  CHECK(space.joints.at(0).joint == "HandRight");
  CHECK(space.joints.at(1).joint == "Head");
  CHECK(space.joints.at(0).after_m > 2.0 * space.after_m);
}

TEST_CASE("KinectMultiTrack: the second Kinect onto the first by the server's stamps" *
          doctest::skip(!shared_data())) {
  const FreshFolder scratch;
  unpack_multitrack(scratch);
  struct Row {
    std::string file;
    double stand, step;  // cm
  };
  for (const Row& row : std::vector<Row>{{"Study_0_Kinect_0_Time_11_35_09_AM", 2.6, 3.1},
                                         {"Study_2_Kinect_0_Time_12_18_53_PM", 1.5, 2.6},
                                         {"Study_5_Kinect_0_Time_1_51_42_PM", 2.0, 3.3},
                                         {"Study_7_Kinect_0_Time_3_04_30_PM", 1.5, 2.5},
                                         {"Study_8_Kinect_0_Time_3_21_28_PM", 2.1, 3.7},
                                         {"Study_1_Kinect_1_Time_11_59_41_AM", 6.1, 4.2},
                                         {"Study_2_Kinect_1_Time_12_23_06_PM", 3.7, 5.0},
                                         {"Study_3_Kinect_1_Time_12_46_32_PM", 17.6, 13.6},
                                         {"Study_5_Kinect_1_Time_1_55_35_PM", 3.1, 4.2},
                                         {"Study_6_Kinect_1_Time_2_36_58_PM", 11.3, 7.1},
                                         {"Study_0_Kinect_2_Time_11_42_45_AM", 14.7, 11.7},
                                         {"Study_1_Kinect_2_Time_12_03_46_PM", 7.1, 7.8},
                                         {"Study_2_Kinect_2_Time_12_26_01_PM", 11.6, 10.5},
                                         {"Study_3_Kinect_2_Time_12_49_36_PM", 18.8, 17.2},
                                         {"Study_5_Kinect_2_Time_1_58_35_PM", 5.8, 13.6}}) {
    CAPTURE(row.file);
    const std::string path = scratch.path() + "/" + row.file + ".csv";
    for (const auto& [scenario, expected] : {std::pair{1, row.stand}, {2, row.step}}) {
      const auto take = aligned(two_kinects(path, scenario));
      REQUIRE(take);
      CHECK(std::abs(100.0 * take->report.spaces.at(0).after_m - expected) < 0.3);
    }
  }
}

TEST_CASE("KinectMultiTrack: what is told late is late by the devices' own ticks too" *
          doctest::skip(!shared_data())) {
  const FreshFolder scratch;
  unpack_multitrack(scratch);
  std::string layout(*builtin_layout("kinect_multitrack"));
  const auto column = layout.find("column = "), body = layout.find("[joints]");
  layout.replace(column, body - column, "column = \"Skeleton_Time\"\nunit = \"ticks_100ns\"\n\n");
  const std::string ticks = scratch.write("ticks.toml", layout);
  for (const auto& file : std::filesystem::directory_iterator(scratch.path())) {
    if (file.path().extension() != ".csv") continue;
    CAPTURE(file.path().filename().string());
    const auto arrived = stamps_by("kinect_multitrack", file.path().string());
    const auto taken = stamps_by(ticks, file.path().string());
    REQUIRE(arrived.size() == taken.size());
    constexpr std::int64_t step = 34'000'000;
    ArrivalSurveyor surveyor(step);
    std::uint64_t late = 0;
    std::int64_t worst = 0, last = INT64_MIN;
    for (std::size_t i = 0; i < arrived.size(); ++i) {
      if (arrived[i] <= last || arrived[i] > arrived.back()) continue;  // repeated, or wild
      surveyor.add(last = arrived[i]);
      std::int64_t by = 0;  // the lateness against the best of the next 300
      for (std::size_t j = i; j < std::min(i + 300, arrived.size()); ++j) {
        by = std::max(by, (arrived[i] - arrived[j]) - (taken[i] - taken[j]));
      }
      late += by >= late_steps * step ? 1 : 0;
      worst = std::max(worst, by);
    }
    CHECK(surveyor.result().late > 20);
    CHECK(surveyor.result().late <= late);
    CHECK(surveyor.result().worst_late_ns <= worst);
  }
}

TEST_CASE("nine IMUs, optical joints and the solved BVH of one walk come onto one grid" *
          doctest::skip(!shared_data())) {
  const std::string folder = shared_path("imu_pose/unsw_walk/");
  Manifest manifest;
  manifest.streams.push_back(
      stream("optical", folder + "vicon_S02-Trial-Walk-1.csv", "unsw_vicon"));
  StreamOptions imu;
  imu.name = "imu";
  imu.layout = "unsw_imu";
  imu.root_node = "Pelvis";
  for (const std::string node : {"Pelvis", "L_UpLeg", "L_LowLeg", "L_LowLeg2", "L_Foot", "R_UpLeg",
                                 "R_LowLeg", "R_LowLeg2", "R_Foot"}) {
    imu.files.push_back({folder + "imu/S02-Trial-Walk-1-" + node + ".csv", node});
  }
  manifest.streams.push_back(imu);
  // Millimetres; frame 1120 is optical row 0.
  StreamOptions suit = stream("suit", folder + "xsens_S02-Trial-Walk-1.bvh", "bvh");
  suit.metres_per_unit = 0.001;
  suit.start_ns = -11'200'000'000;
  manifest.streams.push_back(suit);
  const auto take = aligned(manifest);
  REQUIRE(take);
  CHECK(take->header.frames == 955);

  const auto truth = columns(shared_text("imu_pose/unsw_walk/vicon_S02-Trial-Walk-1.csv"));
  const auto pelvis = rotations(truth, "qRPV");
  const auto& nodes = std::get<ImuGroup>(take->header.groups[1].kind).node_names;
  const auto& rows = std::get<ImuRows>(take->all.rows[1]);
  for (const auto& [node, segment, bar] :
       {std::tuple{"L_LowLeg2", "qLSK", 10.4}, {"R_LowLeg2", "qRSK", 11.6}}) {
    CAPTURE(node);
    const auto column =
        static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
    const auto shank = rotations(truth, segment);
    std::vector<Quat> worn, seen;
    for (std::size_t r = 0; r < 955; ++r) {
      worn.push_back(quat(rows.orientation, r * nodes.size() + column));
      seen.push_back(pelvis[r].conjugate() * shank[r]);
    }
    CHECK(constant_rotations_leave(worn, seen) < bar);
  }
  // The suit's hips are at those of the optical system: the heights agree to some centimetres.
  const auto& suit_rows = std::get<ClipRows>(take->all.rows[2]);
  const auto& optical = std::get<PointRows>(take->all.rows[0]);
  const std::size_t suit_width = suit_rows.positions.size() / 955;
  const std::size_t optical_width = optical.positions.size() / 955;
  for (std::size_t r = 0; r < 955; r += 50) {
    CHECK(std::abs(suit_rows.positions[r * suit_width + 1] -
                   optical.positions[r * optical_width + 1]) < 0.1);
  }
}
