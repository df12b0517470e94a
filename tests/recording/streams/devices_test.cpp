// SPDX-License-Identifier: Apache-2.0
// Which device of a recording is read, and the findings about the file.
#include "tests/recording/streams/recorded_streams.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/documents/manifest_toml.h"
#include "kinalign/recording/recover.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/recording/survey.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace kinalign;
using namespace std::chrono_literals;

TEST_CASE("a recording's marks stand on the take's axis") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 4.0);
  lab.add_mark(1.0, {Mark::Kind::start, "dance", Duration{53'000'000}, "1"});
  lab.add_mark(3.0, {Mark::Kind::text, "a word", std::nullopt, "2"});
  PosixFiles files;
  const SharedFile file =
      opened_file(files, stream_named("imu", folder.write("take.mcap", lab.file())));
  const std::vector<TakeMark>& marks = file.marks;
  REQUIRE(marks.size() == 2);
  CHECK(marks[0] == TakeMark{utc_time(RecordedLab::utc_begin + 1'000'000'000), "start", "dance",
                             Duration{53'000'000}, "call"});
  CHECK(marks[1].text == "a word");
  CHECK(marks[1].at - marks[0].at == std::chrono::seconds(2));
}

TEST_CASE("what a recording does not have, and what of it is not looked at, is told") {
  const FreshFolder folder;
  RecordedLab lab(20261124);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 4.0);
  for (std::size_t k = 0; k < most_marks + 2; ++k) {
    lab.add_mark(1.0, {Mark::Kind::text, "a word", std::nullopt, ""});
  }
  lab.dropped = 5;
  PosixFiles files;
  const SharedFile file =
      opened_file(files, stream_named("imu", folder.write("take.mcap", lab.file())));
  CHECK(file.marks.size() == most_marks);
  REQUIRE(file.findings.size() == 2);
  CHECK(file.findings[0].what.found == "2 more");
  CHECK(file.findings[1].what.found == "5 fewer, all devices together");
}

TEST_CASE("whatever byte of a recording's summary is damaged, its streams are the same") {
  const FreshFolder folder;
  RecordedLab lab(20261125);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 1.0, "waist");
  const std::string whole = lab.file();
  PosixFiles files;
  const auto samples = [&](const std::string& bytes) {
    const std::string path = folder.write("take.mcap", bytes);
    return node_errors(opened(files, stream_named("imu", path))).samples;
  };
  const std::size_t all = samples(whole);
  const std::size_t summary = whole.rfind("/imu/12/raw");  // the last occurrence is in the summary
  for (std::size_t at = summary - 20; at < summary + 200; ++at) {
    CAPTURE(at);
    std::string damaged = whole;
    damaged[at] ^= 0x10;
    CHECK(samples(damaged) == all);
  }
}

TEST_CASE("what is not in a recording is refused by the names of what is") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 2.0);
  lab.add_node(13, 1, {4.0, 10.0}, 0.0, 2.0, "waist");
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto refusal = [&](const StreamOptions& options) {
    const auto streams = open_streams(files, {options});
    REQUIRE(!streams);
    return streams.error().expected + "; " + streams.error().found;
  };
  CHECK(refusal(stream_named("mocap", path)) ==
        "select.stream (or the stream's name) to be one of imu; 'mocap'");
  CHECK(refusal(stream_named("imu", path)) ==
        "one node of stream imu: select = { node = \"12\" }; or all nodes, with this "
        "line instead of file: files = { 12 = \"" +
            path + "\", waist = \"" + path + "\" }; 12, 13 (waist)");
  CHECK(refusal(stream_named("imu", path, "14")) == "of stream imu node 12, 13 (waist); '14'");
  StreamOptions options = stream_named("imu", path, "12");
  options.select["colour"] = "red";
  CHECK(refusal(options) ==
        "select by stream, node, sender, body or kind (poses, trackers); colour = red");
}

TEST_CASE("a recording's manifest has its devices: mocap's grid first, nodes as one stream") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 2.0, "waist");
  lab.add_node(13, 1, {4.0, 10.0}, 0.0, 2.0);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 2.0);
  lab.add_mocap(NoitomForm::new_header, "udp", 2.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto survey = survey_recording(files, path);
  REQUIRE(survey);
  const auto manifest = manifest_of(*survey, "take.mcap");
  REQUIRE(manifest);
  CHECK(manifest->subject == "03");
  CHECK(manifest->action == "S1A02");
  REQUIRE(manifest->streams.size() == 3);
  CHECK(manifest->streams[0].name == "mocap");
  CHECK(manifest->streams[1].name == "kinect");
  CHECK(manifest->streams[2].name == "imu");
  REQUIRE(manifest->streams[2].files.size() == 2);
  // The lab names this node; the other one it does not name.
  CHECK(manifest->streams[2].files[0].node == "waist");
  CHECK(manifest->streams[2].files[1].node == "13");
  REQUIRE(manifest->spaces.size() == 1);
  CHECK(manifest->spaces.at("kinect").method == "fit");
  const auto recording = open_recording(files, *manifest, folder.path() + "/");
  REQUIRE(recording);
  CHECK(recording->streams.size() == 4);
}

TEST_CASE("a recording that a manifest spells in two ways is one file") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 2.0);
  lab.add_mocap(NoitomForm::new_header, "udp", 2.0);
  folder.write("take.mcap", lab.file());
  PosixFiles files;
  Manifest manifest;
  manifest.streams = {stream_named("mocap", "take.mcap"), stream_named("kinect", "./take.mcap")};
  const auto recording = open_recording(files, manifest, folder.path() + "/");
  REQUIRE(recording);
  CHECK(recording->shared_files.size() == 1);
  CHECK(recording->streams[0].shared_file == recording->streams[1].shared_file);
}

TEST_CASE("a wall clock that is set while recording is told by the recording's survey") {
  const FreshFolder folder;
  PosixFiles files;
  for (const double step_s : {0.0, -0.25, 3.0}) {
    RecordedLab lab(20261123);
    lab.add_clock(20.0, 12.0, step_s);
    const auto survey = survey_recording(files, folder.write("take.mcap", lab.file()));
    REQUIRE(survey);
    REQUIRE(survey->steps.size() == (step_s == 0.0 ? 0 : 1));
    if (survey->steps.empty()) continue;
    CHECK(survey->steps[0].at == RecordedLab::host(12.0));
    CHECK(seconds(survey->steps[0].by) == doctest::Approx(step_s));
  }
}

TEST_CASE("a datagram of another program before the device's is not read, and reported") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 40.0);
  lab.add_datagram({"kinect", "kinect", "udp", "10.0.0.66:40000", "", ""}, 0.0, "GET / HTTP/1.0");
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("kinect", path));
  CHECK(kinect_errors(stream).samples == 1200);
  const auto told = warnings(stream);
  REQUIRE(!told.empty());
  CHECK(told.front() == path +
                            ": expected one sender of kinect, found also 10.0.0.66; only the "
                            "sender with the most messages, 10.0.0.9, was read");
}

TEST_CASE("if another sender is busier than the device, the error names both, and select the one") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 2.0);
  const RawChannel stranger{"kinect", "kinect", "udp", "10.0.0.66:40000", "", ""};
  for (int k = 0; k < 200; ++k) lab.add_datagram(stranger, 0.01 * k, "GET / HTTP/1.0");
  PosixFiles files;
  const std::string path = folder.write("take.mcap", lab.file());
  StreamOptions kinect = stream_named("kinect", path);
  const auto busiest = open_streams(files, {kinect});
  REQUIRE(!busiest);
  CHECK(busiest.error().found ==
        "none from 10.0.0.66; sender = \"...\" chooses one of 10.0.0.66, 10.0.0.9");
  kinect.select["sender"] = "10.0.0.9";
  CHECK(kinect_errors(opened(files, kinect)).samples == 60);
}

namespace {

/// Adds a frame of Kinect sensor 2, received from that sender's address at `at` s.
void add_kinect_frame(RecordedLab& lab, const std::string& sender, std::uint32_t session,
                      std::uint32_t sequence, double at) {
  KinectFrame frame;
  frame.origin = {2, session, sequence};
  frame.device_ticks = static_cast<std::int64_t>(1e7 * at);
  frame.taken_ticks = frame.sent_ticks = frame.device_ticks + 1000;
  frame.bodies.resize(1);
  frame.bodies[0].states.fill(2);
  const auto bytes = encode_kinect_binary(frame);
  lab.add_datagram({"kinect", "kinect", "udp", sender, "", ""}, at,
                   std::string(bytes.begin(), bytes.end()));
}

}  // namespace

TEST_CASE("two Kinects with one id are told of by check, and by who reads one of them") {
  struct Pair {
    std::string first, second, read, meaning;
  };
  for (const Pair& pair : {Pair{"10.0.0.8:5", "10.0.0.9:5", "one sender of kinect",
                                "only the sender with the most messages, 10.0.0.8, was read"},
                           Pair{"10.0.0.8:5", "10.0.0.8:6", "one sender of kinect",
                                "only the sender with the most messages, 10.0.0.8, was read"},
                           Pair{"10.0.0.8:5", "10.0.0.8:5", "one sender of Kinect sensor 2",
                                "frames of the newest session were read; 100 frames of other "
                                "sessions were left out"}}) {
    CAPTURE(pair.second);
    const FreshFolder folder;
    RecordedLab lab(20261123);
    for (std::uint32_t k = 0; k < 101; ++k) {
      const double t = k / 30.0;
      add_kinect_frame(lab, pair.first, 111, k, t);
      if (k < 100) add_kinect_frame(lab, pair.second, 222, k, t + 0.01);
    }
    const std::string path = folder.write("take.mcap", lab.file());
    PosixFiles files;
    const auto survey = survey_recording(files, path);
    REQUIRE(survey);
    REQUIRE(survey->findings.size() == 1);
    CHECK(to_string(survey->findings[0].what) ==
          fmt::format(
              "{}: expected one sender of Kinect sensor 2, found two at a time: {} in session "
              "111, {} in session 222",
              path, pair.first, pair.second));
    const RecordedStream stream = opened(files, stream_named("kinect", path));
    const auto told = warnings(stream);
    CHECK(std::any_of(told.begin(), told.end(), [&](const std::string& one) {
      return one.find(fmt::format("expected {}, found", pair.read)) != std::string::npos &&
             one.ends_with(pair.meaning);
    }));
    const auto recovered = recover_recording(files, {path}, folder / "whole.mcap", Overwrite::no);
    REQUIRE(recovered);  // the file has no fault
    CHECK(recovered->messages == 201);
  }
}

TEST_CASE("what has to stand in a manifest for several nodes names the file as the manifest does") {
  const FreshFolder folder;
  RecordedLab lab(20261125);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 2.0, "left hand");
  lab.add_node(13, 1, {4.0, 10.0}, 0.0, 2.0, "waist");
  folder.write("takes/take.mcap", lab.file());
  PosixFiles files;
  Manifest manifest;
  manifest.streams = {stream_named("imu", "takes/take.mcap")};
  const auto refused = open_recording(files, manifest, folder.path() + "/");
  REQUIRE_FALSE(refused);
  const std::string& said = refused.error().expected;
  const std::string lines =
      R"(files = { "left hand" = "takes/take.mcap", waist = "takes/take.mcap" })";
  REQUIRE_MESSAGE(said.ends_with(lines), said);
  CHECK(said.find("select = { node = \"left hand\" }") != std::string::npos);
  const auto pasted = read_manifest("[stream.imu]\n" + lines, "recording.toml");
  REQUIRE(pasted);
  CHECK(open_recording(files, *pasted, folder.path() + "/").value().streams.size() == 2);
}

TEST_CASE("where nothing is of a stream's protocol the stream is named, and where to look") {
  const FreshFolder folder;
  RecordedLab lab(20261125);
  for (const std::string protocol : {"noitom", "xsens", "kinect"}) {
    lab.add_datagram({protocol, protocol, "udp", "10.0.0.66:40000", "", ""}, 0.0, "GET /");
  }
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  for (const auto& [protocol, what] : {std::pair("noitom", "frames of Noitom's stream"),
                                       std::pair("xsens", "poses (type 02) of Xsens MVN"),
                                       std::pair("kinect", "frames of a Kinect")}) {
    const auto streams = open_streams(files, {stream_named(protocol, path)});
    REQUIRE_FALSE(streams);
    CHECK(to_string(streams.error()) == path + ": expected " + what + " in stream " + protocol +
                                            " (no message is of this protocol: check the port and "
                                            "the protocol that the device sends "
                                            "to), found none");
  }
}

TEST_CASE("a recording without a row for the stream is an error of a kind of its own") {
  const FreshFolder folder;
  RecordedLab lab(20261126);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 2.0);
  lab.add_datagram({"kinect", "kinect", "udp", "10.0.0.66:40000", "", ""}, 0.0, "GET /");
  lab.add_datagram({"slimevr", "slimevr", "udp", "10.0.0.66:40001", "", ""}, 0.0, "GET /");
  lab.add_datagram({"odd", "of_tomorrow", "udp", "10.0.0.66:40002", "", ""}, 0.0, "GET /");
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto kind = [&](const StreamOptions& options) {
    const auto streams = open_streams(files, {options});
    REQUIRE_FALSE(streams);
    return streams.error().kind;
  };
  for (const char* stream : {"kinect", "slimevr", "odd"}) {
    CAPTURE(stream);
    CHECK(kind(stream_named(stream, path)) == ErrorKind::no_rows_in_recording);
  }
  CHECK(kind(stream_named("imu", path, "14")) == ErrorKind::no_rows_in_recording);
  CHECK(kind(stream_named("mocap", path)) == ErrorKind::other);
}

TEST_CASE("a body that does not speak is not taken for another protocol") {
  const FreshFolder folder;
  RecordedLab lab(20261125);
  lab.add_xsens(1.0);
  PosixFiles files;
  StreamOptions options = stream_named("xsens", folder.write("take.mcap", lab.file()));
  options.select = {{"body", "7"}};
  const auto streams = open_streams(files, {options});
  REQUIRE_FALSE(streams);
  CHECK(streams.error().expected == "poses (type 02) of Xsens MVN in stream xsens");
  CHECK(streams.error().found == "120 messages, all of other types or bodies");
}

TEST_CASE("one datagram that was passed over is one") {
  const FreshFolder folder;
  RecordedLab lab(20261125);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 4.0);
  lab.add_datagram({"imu", "kinalign-node", "udp", "10.0.0.7:5005", "12", ""}, 2.0, "GET /");
  PosixFiles files;
  const RecordedStream stream =
      opened(files, stream_named("imu", folder.write("take.mcap", lab.file())));
  REQUIRE(stream.findings.size() == 1);
  CHECK(
      stream.findings.front().what.found ==
      "1 datagrams that were damaged, late or duplicate, or of a session that was never confirmed");
}

TEST_CASE("a stranger at the trackers' port is no node of the manifest") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_datagram({"slime", "slimevr", "udp", "10.0.0.66:40000", "", ""}, 0.0, "GET / HTTP/1.0");
  lab.add_tracker("10.0.0.21", 2.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto manifest = manifest_of(*survey_recording(files, path), path);
  REQUIRE(manifest);
  REQUIRE(manifest->streams.size() == 1);
  REQUIRE(manifest->streams.front().files.size() == 1);
  CHECK(manifest->streams.front().files.front().node == "10.0.0.21");
}

TEST_CASE("of two nodes in one place each is a stream of its own, by its id") {
  const FreshFolder folder;
  RecordedLab lab(20261125);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 5.0, "waist");
  lab.add_node(13, 1, {4.0, 20.0}, 0.0, 5.0, "waist");
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto manifest = manifest_of(*survey_recording(files, path), path);
  REQUIRE(manifest);
  std::vector<std::string> nodes;
  for (const StreamFile& file : manifest->streams.front().files) nodes.push_back(file.node);
  CHECK(nodes == std::vector<std::string>{"12", "13"});
  CHECK(open_streams(files, manifest->streams));
  StreamOptions both = manifest->streams.front();
  both.files = {{path, "waist"}};
  const auto mixed = open_streams(files, {both});
  REQUIRE_FALSE(mixed);
  CHECK(mixed.error().expected == "one node of stream imu that is called waist");
  CHECK(mixed.error().found == "12 (waist), 13 (waist)");
}

TEST_CASE("each sensor of a tracker that has several is a node") {
  const FreshFolder folder;
  RecordedLab lab(20261124);
  lab.add_tracker("10.0.0.21", 20.0, 0, 2);
  lab.add_tracker("10.0.0.22", 20.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto manifest = manifest_of(*survey_recording(files, path), path);
  REQUIRE(manifest);
  REQUIRE(manifest->streams.size() == 1);
  std::vector<std::string> nodes;
  for (const StreamFile& file : manifest->streams.front().files) nodes.push_back(file.node);
  CHECK(nodes == std::vector<std::string>{"10.0.0.21/0", "10.0.0.21/1", "10.0.0.22"});
  const auto streams = open_streams(files, manifest->streams);
  REQUIRE(streams);
  REQUIRE(streams->streams.size() == 3);
  for (const RecordedStream& stream : streams->streams) {
    CHECK(stream.findings.size() == 1);
    CHECK(says_arrivals(stream));
    CHECK(node_errors(stream).samples == 2000);
  }
  CHECK(std::get<ImuInput>(streams->streams[1].data).node_names ==
        std::vector<std::string>{"10.0.0.21/1"});
  // A reader who asks for one tracker only gets a finding about the others.
  const RecordedStream first = opened(files, stream_named("slime", path, "10.0.0.21"));
  REQUIRE(warnings(first).size() == 1);
  CHECK(warnings(first).front() == path +
                                       ": expected one sensor of tracker 10.0.0.21, "
                                       "found 2 sensors; only the sensor that sent first was read");
}

TEST_CASE(
    "of two sources on one host at the same time the busiest is read, and either by its port") {
  const FreshFolder folder;
  PosixFiles files;
  for (const std::string transport : {"tcp", "udp"}) {
    CAPTURE(transport);
    RecordedLab lab(20261123);
    lab.add_mocap(NoitomForm::new_header, transport, 40.0, 9, "10.0.0.3:7012");
    lab.add_mocap(NoitomForm::new_header, transport, 40.0, 10, "10.0.0.3:7013");
    const std::string path = folder.write(transport + ".mcap", lab.file());
    const RecordedStream stream = opened(files, stream_named("mocap", path));
    const Errors errors = mocap_errors(stream);
    CHECK(errors.samples == 5000 - 5000 / 10);
    CHECK(errors.least > 0.2);
    CHECK(errors.most < 1.0);
    const auto told = warnings(stream);
    REQUIRE(!told.empty());
    CHECK(told.front() == path +
                              ": expected one sender of mocap, found also 10.0.0.3:7012; only the "
                              "sender with the most messages, 10.0.0.3, was read");
    StreamOptions other = stream_named("mocap", path);
    other.select["sender"] = "10.0.0.3:7012";
    CHECK(mocap_errors(opened(files, other)).samples == 5000 - 5000 / 9);
  }
}

TEST_CASE("mocap frames in two datagrams each are stamped as those in one, the last one too") {
  const FreshFolder folder;
  PosixFiles files;
  std::vector<Errors> errors;
  for (const bool is_cut : {false, true}) {
    RecordedLab lab(20261125);
    lab.add_mocap(NoitomForm::new_header, "udp", 20.0);
    if (is_cut) lab.cut_in_two();
    const RecordedStream stream =
        opened(files, stream_named("mocap", folder.write("take.mcap", lab.file())));
    errors.push_back(mocap_errors(stream));
  }
  CHECK(errors[0].samples == 2500);
  CHECK(errors[1].samples == 2500);
  CHECK(errors[1].least == doctest::Approx(errors[0].least));
  CHECK(errors[1].most == doctest::Approx(errors[0].most));
}

TEST_CASE("of Xsens' stream the trackers are taken where they are asked for, else the poses") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_xsens(20.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  StreamOptions options = stream_named("xsens", path);
  CHECK(std::get<ClipInput>(opened(files, options).data).skeleton.joints() == 23);
  options.select = {{"kind", "trackers"}};
  const RecordedStream stream = opened(files, options);
  const auto& input = std::get<ImuInput>(stream.data);
  CHECK(input.node_names == std::vector<std::string>{"Pelvis", "T8", "RightHand"});
  CHECK(input.content == ImuContent{true, true, true, true});
  const Errors errors = errors_of<ImuInput>(
      stream, [](const ImuSamples& s, std::size_t t) { return s.acceleration[9 * t]; });
  CHECK(errors.samples == 1200);
  CHECK(errors.certified == 0);
  CHECK(errors.least > 0.2);
  CHECK(errors.most < 1.5);
}

TEST_CASE("mocap that was recorded without a skeleton gets the one that the manifest names") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_mocap(NoitomForm::new_header, "udp", 20.0);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 2.0);
  lab.forget_skeleton();
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  StreamOptions options = stream_named("mocap", path);
  const auto without = open_streams(files, {options});
  REQUIRE(!without);
  CHECK(without.error().expected.find("set skeleton = \"a.bvh\" in the ") != std::string::npos);
  options.skeleton = folder.write("suit.bvh", noitom_chain("Spine3", false));
  const RecordedStream stream = opened(files, options);
  CHECK(stream.files.size() == 2);  // its hash is computed, too
  CHECK(std::get<ClipInput>(stream.data).skeleton.joints() == 59);
  CHECK(mocap_errors(stream).samples == 2500);
  options.name = "kinect";
  const auto of_kinect = open_streams(files, {options});
  REQUIRE(!of_kinect);
  CHECK(of_kinect.error().expected == "a skeleton only for a noitom stream");
}
