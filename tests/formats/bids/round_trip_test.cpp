// SPDX-License-Identifier: Apache-2.0
// BIDS-Motion files that were written are read again, and npm's bids-validator accepts them.
#include "tests/formats/bids/data_set.h"
#include "tests/formats/reading.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/formats/bids/system.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace kinalign;

namespace {

/// A data set on the disk.
struct Folder {
  FreshFolder folder;
  DataSet set;
  PosixFiles files;

  explicit Folder(const DataSet& given) : set(given) {
    for (const auto& [path, text] : set) folder.write(path, text);
  }
  std::string path(const std::string& system) const {
    return folder / bids_path(bids_system(system), "motion.tsv");
  }
  const std::string& text(const std::string& system) const {
    return set.at(bids_path(bids_system(system), "motion.tsv"));
  }
  BidsSystem system(const std::string& name) {
    auto read = read_bids_system(files, path(name));
    if (!read) FAIL(to_string(read.error()));
    return *read;
  }
  Read<PointReader> points(const std::string& name, const StreamOptions& options = {}) {
    return read_in_pieces(make_bids_point_reader(system(name), options, "m.tsv").value(),
                          text(name), 997);
  }
  Read<ImuReader> nodes(const std::string& name) {
    return read_in_pieces(make_bids_node_reader(system(name), {}, "m.tsv").value(), text(name),
                          997);
  }
};

double largest_angle(const std::vector<double>& a, const std::vector<double>& b,
                     const std::vector<std::uint8_t>& valid) {
  if (a.size() != b.size()) return HUGE_VAL;
  double most = 0.0;
  for (std::size_t i = 0; i < valid.size(); ++i) {
    if (valid[i] != 0) most = std::max(most, quat(a, i).angularDistance(quat(b, i)));
  }
  return most;
}

/// The path of a node_modules folder with bids-validator 1.15.0, which is too large (700 MB)
/// for ./dev test to install: npm install --prefix build/npm bids-validator@1.15.0 --ignore-scripts
std::string node_modules() {
  const char* given = std::getenv("KINALIGN_NODE_MODULES");
  return given != nullptr ? given : KINALIGN_SOURCE_DIR "/build/npm/node_modules";
}

bool has_validator() {
  return std::filesystem::exists(node_modules() + "/bids-validator/bin/bids-validator");
}

/// The keys of the validator's errors and warnings, one a line.
std::string validated(const FreshFolder& folder) {
  const FreshFolder place;
  const std::string command =
      "/usr/bin/python3 " KINALIGN_SOURCE_DIR "/tests/witness/bids_validator.py '" +
      node_modules() + "' '" + folder.path() + "' > '" + (place / "out") + "'";
  if (std::system(command.c_str()) != 0) return "the validator failed";
  return place.read("out");
}

}  // namespace

TEST_CASE("points are read again to half a micrometre, their stamps exactly") {
  for (const std::uint64_t seed : fresh_seeds(5)) {
    CAPTURE(seed);
    const BidsStreams streams = bids_streams(seed);
    Folder folder(bids_data_set(streams));
    const auto read = folder.points("kinect");
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.header.joint_names == streams.points.joint_names);
    CHECK(read.rows.stamps == streams.points.frames.stamps);
    CHECK(read.rows.state == streams.points.frames.state);
    CHECK(largest_difference(read.rows.positions, streams.points.frames.positions) <= 0.51e-6);
  }
}

TEST_CASE("nodes are read again: orientations to 2e-9 rad, the others to half a millionth") {
  for (const std::uint64_t seed : fresh_seeds(5)) {
    CAPTURE(seed);
    const BidsStreams streams = bids_streams(seed);
    Folder folder(bids_data_set(streams));
    const auto read = folder.nodes("imu");
    const ImuSamples& given = streams.nodes.samples;
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.header.node_names == streams.nodes.node_names);
    CHECK(read.header.content == streams.nodes.content);
    CHECK(read.rows.stamps == given.stamps);
    CHECK(read.rows.valid == given.valid);
    CHECK(largest_angle(read.rows.orientation, given.orientation, given.valid) <= 2e-9);
    CHECK(largest_difference(read.rows.acceleration, given.acceleration) <= 0.51e-6);
    CHECK(largest_difference(read.rows.angular_velocity, given.angular_velocity) <= 0.51e-6);
  }
}

TEST_CASE("a skeleton's motion is read as global positions, or as global orientations") {
  const BidsStreams streams = bids_streams(fresh_seeds(1).front());
  Folder folder(bids_data_set(streams));
  const Clip& clip = streams.clip;
  std::vector<double> global(clip.frames.local_positions.size());
  forward_kinematics(clip.skeleton, clip.frames, global);
  const auto points = folder.points("suit");
  CHECK(points.error == "");
  CHECK(points.header.joint_names == clip.skeleton.joint_names);
  CHECK(points.rows.stamps == clip.frames.stamps);
  CHECK(largest_difference(points.rows.positions, global) <= 0.51e-6);
  const auto nodes = folder.nodes("suit");
  CHECK(nodes.error == "");
  CHECK(nodes.header.content == ImuContent{true, false, false, true});
  const Quat head = quat(clip.frames.local_rotations, 0) * quat(clip.frames.local_rotations, 1) *
                    quat(clip.frames.local_rotations, 2);
  CHECK(quat(nodes.rows.orientation, 2).angularDistance(head) <= 2e-9);
}

TEST_CASE("our own check finds nothing in what we write") {
  const auto findings = check_set(bids_data_set(bids_streams(fresh_seeds(1).front())));
  for (const Finding& finding : findings) CHECK_MESSAGE(false, text_of(finding));
}

TEST_CASE(
    "npm's bids-validator finds no error in what we write, and the errors that it knows in broken "
    "copies" *
    doctest::skip(!has_validator())) {
  const DataSet set = bids_data_set(bids_streams(1));
  CHECK(validated(Folder(set).folder) == "");
  DataSet broken = set;
  const std::string channels = bids_path(bids_system("suit"), "channels.tsv");
  std::string& table = broken[channels];
  table.replace(table.find("\tPOS\t"), 5, "\tpos\t");
  CHECK(validated(Folder(broken).folder).find("CHANNELS_COLUMN_TYPE") != std::string::npos);
  CHECK(!check_set(broken).empty());
}

TEST_CASE("a start, a rate and an axis of the user win over the files") {
  const BidsStreams streams = bids_streams(3);
  DataSet set = bids_data_set(streams);
  Folder folder(set);
  StreamOptions options;
  options.start_ns = 5;
  options.up = "z";
  options.metres_per_unit = 2.0;
  const auto read = folder.points("kinect", options);
  CHECK(read.rows.stamps[0] == utc_time(5));
  CHECK(read.rows.stamps[1] - read.rows.stamps[0] ==
        streams.points.frames.stamps[1] - streams.points.frames.stamps[0]);
  for (std::size_t i = 0; i < read.rows.state.size(); ++i) {
    if (read.rows.state[i] == Tracking::missing) continue;
    CHECK(read.rows.positions[3 * i + 2] ==
          doctest::Approx(-2.0 * streams.points.frames.positions[3 * i + 1]).epsilon(1e-6));
    break;
  }
}

TEST_CASE("without latencies and scans rows are counted from 0 by SamplingFrequency") {
  const std::string stem = "sub-1/motion/sub-1_task-a_tracksys-b_";
  DataSet set{{stem + "channels.tsv",
               "name\tcomponent\ttype\ttracked_point\tunits\n"
               "a\tx\tPOS\tP\tmm\nb\ty\tPOS\tP\tmm\nc\tz\tPOS\tP\tmm\n"},
              {stem + "motion.json", R"({"SamplingFrequency": 50, "TaskName": "a"})"},
              {stem + "channels.json",
               R"({"reference_frame": {"Levels": {"n/a": {"SpatialAxes": "ALS"}}}})"},
              {stem + "motion.tsv", "1000\t2000\t3000\nn/a\tn/a\tn/a\nnan\t1\t2\n"}};
  FreshFolder folder;
  for (const auto& [path, text] : set) folder.write(path, text);
  PosixFiles files;
  const auto system = read_bids_system(files, folder / (stem + "motion.tsv"));
  REQUIRE(system);
  const auto read =
      read_all(make_bids_point_reader(*system, {}, "m.tsv").value(), set.at(stem + "motion.tsv"));
  CHECK(read.error == "");
  CHECK(read.rows.stamps ==
        std::vector<Time>{utc_time(0), utc_time(20'000'000), utc_time(40'000'000)});
  CHECK(std::vector<double>(read.rows.positions.begin(), read.rows.positions.begin() + 3) ==
        std::vector<double>{1, 3, -2});
  CHECK(read.rows.state ==
        std::vector<Tracking>{Tracking::tracked, Tracking::missing, Tracking::missing});
  REQUIRE(read.findings.size() == 1);
  CHECK(text_of(read.findings[0]) ==
        "m.tsv: expected n/a for what is missing, found 1 cells that are empty or nan");
  CHECK(to_string(make_bids_node_reader(*system, {}, "m.tsv").error()) ==
        "m.tsv: expected ORNT channels of a quaternion, ACCEL or GYRO channels, found none");
}

TEST_CASE("what can't be read is an error with its place") {
  const std::string stem = "sub-1/motion/sub-1_task-a_tracksys-b_";
  const std::string head = "name\tcomponent\ttype\ttracked_point\tunits\treference_frame\n";
  const auto error_of = [&](const std::string& channels, const std::string& json,
                            const std::string& axes, const std::string& rows) -> std::string {
    FreshFolder folder;
    folder.write(stem + "channels.tsv", channels);
    folder.write(stem + "motion.json", json);
    folder.write(
        stem + "channels.json",
        "{\"reference_frame\": {\"Levels\": {\"g\": {\"SpatialAxes\": \"" + axes + "\"}}}}");
    const std::string path = folder.write(stem + "motion.tsv", rows);
    PosixFiles files;
    const auto system = read_bids_system(files, path);
    std::string error;
    if (!system) {
      error = to_string(system.error());
    } else if (has_positions(*system)) {
      auto reader = make_bids_point_reader(*system, {}, path);
      error = reader ? read_all(std::move(*reader), rows).error : to_string(reader.error());
    } else {
      auto reader = make_bids_node_reader(*system, {}, path);
      error = reader ? read_all(std::move(*reader), rows).error : to_string(reader.error());
    }
    const auto at = error.find("sub-1/motion/sub-1_task-a_tracksys-b_");
    return at == std::string::npos ? error : error.substr(at + stem.size());
  };
  const std::string good = R"({"SamplingFrequency": 50})";
  const std::string places = head + "a\tx\tPOS\tP\tm\tg\nb\ty\tPOS\tP\tm\tg\nc\tz\tPOS\tP\tm\tg\n";
  CHECK(error_of(places, good, "LSA", "1\t2\t3\n") == "");
  CHECK(error_of(places, good, "LSA", "1\t2\n1\t2\t3\n") ==
        "motion.tsv:1: expected 3 cells, one per row of channels.tsv, found 2");
  CHECK(error_of(places, good, "LSA", "a\tb\tc\n1\t2\t3\n") ==
        "motion.tsv:1: expected a number or n/a (motion.tsv has no line of column names), found a");
  CHECK(error_of(places, "{}", "LSA", "") ==
        "motion.json: expected a SamplingFrequency of 0.001 to 1,000,000, found none");
  CHECK(error_of(places, "[]", "LSA", "") ==
        "motion.json: expected a JSON object, found another JSON value");
  CHECK(error_of(places, "{", "LSA", "") ==
        "motion.json: expected a JSON object, found text that is no JSON");
  CHECK(error_of(places, good, "ABC", "") ==
        "motion.tsv: expected SpatialAxes of three letters, one of which is S or I; otherwise set "
        "up, found ABC");
  CHECK(error_of("name\n", good, "LSA", "") ==
        "channels.tsv:1: expected a column component, found none");
  CHECK(error_of(head + "a\tx\tPOS\tP\tm\tg\n", good, "LSA", "") ==
        "motion.tsv: expected POS channels x, y and z of a tracked point, found none");
  CHECK(error_of(head + "a\tx\tPOS\tP\tft\tg\nb\ty\tPOS\tP\tm\tg\nc\tz\tPOS\tP\tm\tg\n", good,
                 "LSA", "") == "motion.tsv: expected a unit of POS for channel a, found ft");
  const std::string turns = head +
                            "a\tquat_w\tORNT\tP\tn/a\tg\nb\tquat_x\tORNT\tP\tn/a\tg\n"
                            "c\tquat_y\tORNT\tP\tn/a\tg\nd\tquat_z\tORNT\tP\tn/a\tg\n";
  CHECK(error_of(turns, good, "ARS", "") ==
        "motion.tsv: expected orientations in a right-handed space, found left-handed SpatialAxes");
  CHECK(error_of(turns, good, "ALS", "1\t0\t0\t0\n") == "");
}
