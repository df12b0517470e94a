// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/show_recording.h"

#include "tests/folder.h"
#include "tests/formats/xdf/xdf_cases.h"
#include "tests/recording/recorded_lab.h"

#include "kinalign/motion/kinect_joints.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/sources/open_recording.h"
#include "kinalign/view/show_xdf.h"
#include "kinalign/view/shown_rows.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

using namespace kinalign;
using Json = nlohmann::json;

namespace {

struct ShownMessage {
  std::uint64_t log_time = 0;
  Json json;
};

/// The shown messages by topic.
std::map<std::string, std::vector<ShownMessage>> messages_in(const std::string& path) {
  const ReadMcap read = read_mcap(bytes_in(path));
  CHECK(read.closed);
  CHECK(read.findings.empty());
  std::map<std::uint16_t, std::string> topics;
  for (const McapRecord& record : read.records) {
    if (const auto* channel = std::get_if<McapChannel>(&record))
      topics[channel->id] = channel->topic;
  }
  std::map<std::string, std::vector<ShownMessage>> out;
  for (const OwnedMessage& m : read.messages) {
    out[topics.at(m.message.channel)].push_back({m.message.log_time, Json::parse(m.data)});
  }
  return out;
}

double seconds_of(std::uint64_t log_time) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(log_time) - RecordedLab::utc_begin);
}

/// A recording with its further files, as it is shown.
std::map<std::string, std::vector<ShownMessage>> shown_recording(const FreshFolder& folder,
                                                                 const std::string& path) {
  PosixFiles files;
  const auto source = RecordingSource::open(files, path, RecordingSource::Devices::learned);
  REQUIRE(source);
  const auto manifest = manifest_of((*source)->survey(), "take.mcap");
  REQUIRE(manifest);
  const auto recording = open_recording(files, *manifest, folder.path() + "/", {{}, 1, *source});
  REQUIRE(recording);
  const std::string out = folder / "shown.mcap";
  const auto shown = show_recording(files, *recording, {source->get(), out, Overwrite::no});
  REQUIRE(shown);
  CHECK(shown->out_of_range == 0);
  return messages_in(out);
}

/// A lab of three devices as it is shown.
std::map<std::string, std::vector<ShownMessage>> shown_lab(const FreshFolder& folder) {
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 20.0);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 20.0);
  lab.add_mocap(NoitomForm::new_header, "udp", 20.0);
  return shown_recording(folder, folder.write("take.mcap", lab.file()));
}

}  // namespace

TEST_CASE("every sample of a recording is shown as JSON, at its time on UTC") {
  const FreshFolder folder;
  auto shown = shown_lab(folder);
  REQUIRE(shown["/imu/12"].size() == 2 * 301);
  for (const ShownMessage& m : shown["/imu/12"]) {
    const double truth = m.json["acceleration"]["x"];
    CHECK(std::abs(seconds_of(m.log_time) - truth) < 0.0004);
    CHECK(m.json["interval_ns"] > 1'000'000);
    const auto& stamp = m.json["timestamp"];
    CHECK(stamp["sec"].get<std::uint64_t>() * 1'000'000'000 + stamp["nsec"].get<std::uint64_t>() ==
          m.log_time);
  }
  CHECK(shown["/mocap/pose"].size() == 2500);
  CHECK(shown["/kinect/points"].size() == 600);
  const ShownMessage& frame = shown["/kinect/points"].back();
  CHECK(frame.json["joints"].size() == 25);
  CHECK(frame.json["joints"]["Head"]["state"] == "tracked");
  CHECK(!frame.json.contains("interval_ns"));  // no answers carry the sensor's clock
}

TEST_CASE("skeletons are frame transforms, at most 30 a second, from the world to the last joint") {
  const FreshFolder folder;
  auto shown = shown_lab(folder);
  for (const std::string stream : {"mocap", "kinect"}) {
    const auto& messages = shown["/" + stream + "/transforms"];
    CHECK(messages.size() >= 20 * 30 - 1);  // a Kinect's jitter must not cost frames
    CHECK(messages.size() <= 20 * 30 + 1);
    std::map<std::string, std::string> parents;
    for (const Json& one : messages.back().json["transforms"]) {
      parents[one["child_frame_id"]] = one["parent_frame_id"];
    }
    CHECK(parents.size() == (stream == "mocap" ? 59 : 25) + 1);
    std::string at = stream == "mocap" ? "mocap/j58" : "kinect/HandTipLeft";
    int steps = 0;
    while (at != "world" && ++steps < 100) at = parents.at(at);
    CHECK(steps == (stream == "mocap" ? 60 : 9));
  }
}

TEST_CASE("marks and clocks of all parts of a recording are shown, each once") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 10.0);
  lab.add_clock(10.0, 1e9, 0.0);
  for (const double t : {1.0, 5.75, 9.0}) {
    lab.add_mark(t, {Mark::Kind::text, std::to_string(t), std::nullopt, ""});
  }
  const std::string path = folder.write("take.mcap", lab.file({1, -1e9, 6.0}));
  folder.write("take.part2.mcap", lab.file({2, 5.5, 1e9}));  // half a second is in both files
  auto shown = shown_recording(folder, path);
  REQUIRE(shown["/marks"].size() == 3);
  for (const std::size_t k : {0U, 1U, 2U}) {
    CHECK(shown["/marks"][k].json["text"] == std::to_string(std::array{1.0, 5.75, 9.0}[k]));
  }
  CHECK(shown["/clock/host"].size() == 10);
}

TEST_CASE("a Kinect's joint hangs past a missing one, where it was") {
  PointFrames frames;
  frames.stamps = {utc_time(0)};
  frames.positions.assign(75, 0.0);
  frames.state.assign(25, Tracking::tracked);
  const std::size_t elbow = 5, wrist = 6, shoulder = 4;
  frames.state[elbow] = Tracking::missing;
  frames.positions[3 * shoulder] = 0.25;
  frames.positions[3 * wrist] = 1.0;
  const std::vector<std::string> joints(kinect_joints.begin(), kinect_joints.end());
  const Json json = Json::parse(transforms_json("kinect", joints, frames, 0, {}));
  CHECK(json["transforms"].size() == 1 + 24);
  for (const Json& one : json["transforms"]) {
    if (one["child_frame_id"] != "kinect/WristLeft") continue;
    CHECK(one["parent_frame_id"] == "kinect/ShoulderLeft");
    CHECK(one["translation"]["x"] == 0.75);
  }
}

TEST_CASE("an XDF's whole numbers and doubles are shown as they are, on the recorder's clock") {
  const FreshFolder folder;
  const std::int64_t large = 9'007'199'254'740'993;  // a number that no double can hold
  const double third = 1.0 / 3.0;
  const auto bits = [](auto value) { return little_text(std::bit_cast<std::uint64_t>(value)); };
  const std::string path = folder.write(
      "rec.xdf", xdf_begin + xdf_header(1, "int64", 1) + xdf_header(2, "double64", 1) +
                     xdf_samples(1, 1, xdf_sample(10.5, bits(large))) +
                     xdf_samples(2, 1, xdf_sample(10.25, bits(third))) + xdf_offset(2, 9.0, 2.5));
  PosixFiles files;
  const std::string out = folder / "rec.mcap";
  const auto shown = show_xdf(files, path, out, Overwrite::no);
  REQUIRE(shown);
  CHECK(shown->shown.messages == 2);
  auto messages = messages_in(out);
  REQUIRE(messages["/N1"].size() == 1);
  CHECK(messages["/N1"][0].json["values"][0] == large);
  CHECK(messages["/N1"][0].log_time == 10'500'000'000);
  REQUIRE(messages["/N2"].size() == 1);
  CHECK(messages["/N2"][0].json["values"][0] == third);
  CHECK(messages["/N2"][0].log_time == 12'750'000'000);  // by the stream's clock offset
  CHECK(messages["/N2"][0].json["stamp"] == 10.25);
}

TEST_CASE("an XDF's values that are no numbers are words, which say what they were") {
  const FreshFolder folder;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::string doubles, floats;
  for (const double value : {std::nan(""), infinity, -infinity, 0.5}) {
    doubles += little_text(value);
    floats += little_text(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  const std::string path = folder.write(
      "rec.xdf", xdf_begin + xdf_header(1, "double64", 4) + xdf_header(2, "float32", 4) +
                     xdf_samples(1, 1, xdf_sample(10.5, doubles)) +
                     xdf_samples(2, 1, xdf_sample(10.5, floats)));
  PosixFiles files;
  const std::string out = folder / "rec.mcap";
  REQUIRE(show_xdf(files, path, out, Overwrite::no));
  auto messages = messages_in(out);
  for (const char* topic : {"/N1", "/N2"}) {
    REQUIRE(messages[topic].size() == 1);
    CHECK(messages[topic][0].json["values"] == Json{"NaN", "Infinity", "-Infinity", 0.5});
  }
}
