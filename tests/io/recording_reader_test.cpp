// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/recording_reader.h"

#include "tests/folder.h"
#include "tests/io/recorded_lab.h"

#include "kinalign/io/open_recording.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

StreamOptions stream_named(const std::string& name, const std::string& path,
                           const std::string& node = "") {
  StreamOptions options;
  options.name = name;
  options.files = {{path, node}};
  return options;
}

RecordedStream opened(FileSystem& files, const StreamOptions& options) {
  auto streams = open_streams(files, {options});
  INFO(options.name);
  if (!streams) FAIL(streams.error().expected, ", found ", streams.error().found);
  REQUIRE(streams->size() == 1);
  return std::move(streams->front());
}

/// What it warns of, and what that means.
std::vector<std::string> warnings(const RecordedStream& stream) {
  std::vector<std::string> texts;
  for (const Finding& finding : stream.findings) {
    if (finding.severity != Severity::warning) continue;
    texts.push_back(to_string(finding.what) + "; " + finding.meaning);
  }
  return texts;
}

/// How far a stream's stamps are behind the truth that its samples carry, ms.
struct Errors {
  double least = 1e9, most = -1e9, widest = 0.0;  // and the widest half-width
  std::size_t samples = 0, certified = 0, outside = 0;

  void add(const RecordedStream& stream, Time stamp, double truth) {
    const auto error = take_time(stream.clock, stamp) - RecordedLab::utc(truth);
    const double ms = 1e-6 * static_cast<double>(error.count());
    least = std::min(least, ms);
    most = std::max(most, ms);
    ++samples;
    const auto half = half_width(stream.clock, stamp);
    if (!half) return;
    ++certified;
    widest = std::max(widest, 1e-6 * static_cast<double>(half->count()));
    // What single precision leaves of the truth is not the clock's fault.
    outside += std::abs(error.count()) > half->count() + 4000 ? 1 : 0;
  }
};

template <class Input, class Truth>
Errors errors_of(const RecordedStream& stream, Truth truth) {
  auto pass = std::get<Input>(stream.data).passes();
  REQUIRE(pass);
  Errors errors;
  using Frames = std::conditional_t<
      std::is_same_v<Input, ClipInput>, ClipFrames,
      std::conditional_t<std::is_same_v<Input, PointInput>, PointFrames, ImuSamples>>;
  Frames block;
  for (;;) {
    const auto more = (*pass)(block);
    REQUIRE(more);
    if (!*more) return errors;
    for (std::size_t t = 0; t < block.size(); ++t) {
      errors.add(stream, block.stamps[t], truth(block, t));
    }
  }
}

Errors node_errors(const RecordedStream& stream) {
  return errors_of<ImuInput>(
      stream, [](const ImuSamples& s, std::size_t t) { return s.acceleration[3 * t]; });
}
Errors kinect_errors(const RecordedStream& stream) {
  return errors_of<PointInput>(
      stream, [](const PointFrames& f, std::size_t t) { return f.positions[25 * 3 * t]; });
}
Errors mocap_errors(const RecordedStream& stream) {
  return errors_of<ClipInput>(
      stream, [](const ClipFrames& f, std::size_t t) { return f.local_positions[59 * 3 * t]; });
}

}  // namespace

TEST_CASE("a recorded node's samples are stamped by its counter, each within its interval") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 0xb0071, {3.0, -35.0}, 0.0, 40.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("imu", path, "12"));
  CHECK(stream.format == "recording");
  CHECK(stream.findings.empty());
  const auto& input = std::get<ImuInput>(stream.data);
  CHECK(input.node_names == std::vector<std::string>{"12"});
  CHECK(input.content == ImuContent{false, true, true, true});
  const Errors errors = node_errors(stream);
  CHECK(errors.samples == 2 * 600);
  CHECK(errors.certified == errors.samples);
  CHECK(errors.outside == 0);
  CHECK(errors.widest < 2.5);
  CHECK(errors.least > -0.3);
  CHECK(errors.most < 0.3);
}

TEST_CASE("a node that restarts goes on in the same stream, its second life as exact") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 0xb0071, {3000.0, -35.0}, 0.0, 20.0);
  lab.add_node(12, 0xb0072, {-21.0, -35.0}, 24.0, 44.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("imu", path));
  CHECK(stream.survey.backward == 0);
  const Errors errors = node_errors(stream);
  CHECK(errors.samples == 2 * (300 + 301));
  CHECK(errors.outside == 0);
  CHECK(errors.least > -0.5);
  CHECK(errors.most < 0.5);
}

TEST_CASE("a Kinect's stamps are its sensor's ticks, late by the least time to the sender") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 40.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("kinect", path));
  const Errors errors = kinect_errors(stream);
  CHECK(errors.samples == 1200);
  CHECK(errors.certified == 0);
  CHECK(errors.least > 29.5);
  CHECK(errors.most < 31.5);
  // A delay that is known is taken off.
  StreamOptions options = stream_named("kinect", path);
  options.offset_ms = -30.0;
  const Errors moved = kinect_errors(opened(files, options));
  CHECK(moved.least == doctest::Approx(errors.least - 30.0));
}

TEST_CASE("mocap's frames are stamped by their number, over lost ones and its wrap") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_mocap(NoitomForm::new_header, "udp", 40.0, 9);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("mocap", path));
  CHECK(std::get<ClipInput>(stream.data).skeleton.joints() == 59);
  CHECK(stream.survey.median_step_ns == 8'000'000);
  const Errors errors = mocap_errors(stream);
  CHECK(errors.samples == 5000 - 5000 / 9);
  CHECK(errors.least > 0.2);
  CHECK(errors.most < 1.0);
}

TEST_CASE("frames without a number are counted over a connection, and stamped as they come else") {
  const FreshFolder folder;
  PosixFiles files;
  for (const std::string transport : {"tcp", "udp"}) {
    RecordedLab lab(20261123);
    lab.add_mocap(NoitomForm::old_header, transport, 40.0);
    const std::string path = folder.write(transport + ".mcap", lab.file());
    const Errors errors = mocap_errors(opened(files, stream_named("mocap", path)));
    CHECK(errors.samples == 5000);
    CHECK(errors.certified == 0);
    CHECK(errors.least > 0.2);
    if (transport == "tcp") CHECK(errors.most < 1.0);
    if (transport == "udp") CHECK(errors.most > 4.0);
  }
}

TEST_CASE("frames of mocap that were overtaken in the network stand where they belong") {
  const FreshFolder folder;
  PosixFiles files;
  for (const bool xsens : {false, true}) {
    CAPTURE(xsens);
    RecordedLab lab(20261123);
    if (xsens) {
      lab.add_xsens(20.0);
    } else {
      lab.add_mocap(NoitomForm::new_header, "udp", 20.0);
    }
    lab.hold_back(9, xsens ? 0.04 : 0.03);  // up to four are quicker
    const std::string path = folder.write("take.mcap", lab.file());
    const RecordedStream stream = opened(files, stream_named(xsens ? "xsens" : "mocap", path));
    CHECK(stream.survey.backward == 0);
    CHECK(stream.survey.kept() == (xsens ? 1200 : 2500));
    if (xsens) continue;
    const Errors errors = mocap_errors(stream);
    CHECK(errors.samples == 2500);
    CHECK(errors.most - errors.least < 0.5);
  }
}

TEST_CASE("a file that breaks off anywhere is read up to there, and that is said") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 0xb0071, {3.0, -35.0}, 0.0, 10.0);
  const std::string whole = lab.file(false);
  PosixFiles files;
  for (const double share : {0.3, 0.6, 0.9, 1.0}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    const std::string path = folder.write("torn.mcap", whole.substr(0, size));
    const RecordedStream stream = opened(files, stream_named("imu", path));
    const auto torn = std::count_if(
        stream.by_file.findings.begin(), stream.by_file.findings.end(),
        [](const Finding& f) { return f.repair == "kinalign recover makes a whole file of it"; });
    CHECK(torn == 1);
    const Errors errors = node_errors(stream);
    CHECK(errors.outside == 0);
    CHECK(static_cast<double>(errors.samples) > 300.0 * (share - 0.1));
  }
}

TEST_CASE("marks come with each stream of a recording, on the take's axis") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 4.0);
  lab.add_mark(1.0, {Mark::Kind::start, "dance", Duration{53'000'000}, "1"});
  lab.add_mark(3.0, {Mark::Kind::text, "a word", std::nullopt, "2"});
  PosixFiles files;
  const RecordedStream stream =
      opened(files, stream_named("imu", folder.write("take.mcap", lab.file())));
  const std::vector<TakeMark>& marks = stream.by_file.marks;
  REQUIRE(marks.size() == 2);
  CHECK(marks[0] == TakeMark{utc_time(RecordedLab::utc_begin + 1'000'000'000), "start", "dance",
                             Duration{53'000'000}, "call"});
  CHECK(marks[1].text == "a word");
  CHECK(marks[1].at - marks[0].at == std::chrono::seconds(2));
}

TEST_CASE("what is not in a recording is refused by the names of what is") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 2.0);
  lab.add_node(13, 1, {4.0, 10.0}, 0.0, 2.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto refusal = [&](const StreamOptions& options) {
    const auto streams = open_streams(files, {options});
    REQUIRE(!streams);
    return streams.error().expected + "; " + streams.error().found;
  };
  CHECK(refusal(stream_named("mocap", path)) ==
        "select.stream, or a stream's name, of imu; 'mocap'");
  CHECK(refusal(stream_named("imu", path)) == "one node of stream imu: select.node; 12, 13");
  CHECK(refusal(stream_named("imu", path, "14")) == "of stream imu node 12, 13; '14'");
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
  CHECK(manifest->streams[2].files[0].node == "waist");  // where the lab says that
  CHECK(manifest->streams[2].files[1].node == "13");
  REQUIRE(manifest->spaces.size() == 1);
  CHECK(manifest->spaces.at("kinect").method == "fit");
  const auto recording = open_recording(files, *manifest, folder.path() + "/");
  REQUIRE(recording);
  CHECK(recording->streams.size() == 4);
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

TEST_CASE("a SlimeVR tracker's rotations are stamped as they come, with their accelerations") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_tracker("10.0.0.21", 20.0);
  lab.add_tracker("10.0.0.22", 20.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto survey = survey_recording(files, path);
  REQUIRE(survey);
  const auto manifest = manifest_of(*survey, path);
  REQUIRE(manifest);
  const auto streams = open_streams(files, manifest->streams);
  REQUIRE(streams);
  REQUIRE(streams->size() == 2);
  for (const RecordedStream& stream : *streams) {
    CHECK(stream.findings.empty());
    CHECK(std::get<ImuInput>(stream.data).content == ImuContent{true, true, false, false});
    const Errors errors = node_errors(stream);
    CHECK(errors.samples == 2000);
    CHECK(errors.certified == 0);
    CHECK(errors.least > 1.4);
  }
  CHECK(std::get<ImuInput>(streams->back().data).node_names ==
        std::vector<std::string>{"10.0.0.22"});
}

TEST_CASE("a node without a counter is stamped by its requests' numbers, over lost ones") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_clockless_node(9, 40.0, 7);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("imu", path));
  CHECK(stream.findings.empty());
  const Errors errors = node_errors(stream);
  CHECK(errors.samples == 600 - 600 / 7);
  CHECK(errors.certified == 0);
  CHECK(errors.least > -1.0);
  CHECK(errors.most < 1.0);
}

TEST_CASE("a stranger's datagram before the device is not taken for it") {
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
                            ": expected one sender of kinect, found 10.0.0.9, 10.0.0.66; only "
                            "10.0.0.9 was read");
}

TEST_CASE("a stranger who says more than the device is found to be none") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 2.0);
  const RawChannel stranger{"kinect", "kinect", "udp", "10.0.0.66:40000", "", ""};
  for (int k = 0; k < 200; ++k) lab.add_datagram(stranger, 0.01 * k, "GET / HTTP/1.0");
  PosixFiles files;
  const std::string path = folder.write("take.mcap", lab.file());
  CHECK(kinect_errors(opened(files, stream_named("kinect", path))).samples == 60);
}

TEST_CASE("where nobody is the device, its senders are named") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  for (const std::string host : {"10.0.0.66", "10.0.0.67"}) {
    lab.add_datagram({"kinect", "kinect", "udp", host + ":40000", "", ""}, 0.0, "GET /");
  }
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto streams = open_streams(files, {stream_named("kinect", path)});
  REQUIRE(!streams);
  CHECK(to_string(streams.error()) ==
        path +
            ": expected frames of a Kinect, found none from 10.0.0.66; heard were 10.0.0.66, "
            "10.0.0.67: select.sender");
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

TEST_CASE("of two sources on one host that speak in turn one is read, and either by its port") {
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
    CHECK(told.front() ==
          path +
              ": expected one sender of mocap at 10.0.0.3, found 10.0.0.3:7013, 10.0.0.3:7012; of "
              "those that speak in turn only the one that said most was read");
    StreamOptions other = stream_named("mocap", path);
    other.select["sender"] = "10.0.0.3:7012";
    CHECK(mocap_errors(opened(files, other)).samples == 5000 - 5000 / 9);
  }
}

TEST_CASE("a Kinect's lines over UDP are read without their ends") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 10.0, RecordedLab::KinectForm::bare_lines);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  CHECK(kinect_errors(opened(files, stream_named("kinect", path))).samples == 300);
}

TEST_CASE("a tracker goes on behind a datagram with a number that isn't its own") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_tracker("10.0.0.21", 20.0, std::uint64_t{1} << 63U);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const RecordedStream stream = opened(files, stream_named("slime", path));
  CHECK(node_errors(stream).samples == 2001);  // nothing tells the forged one's own sample
  CHECK(stream.findings.empty());
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

TEST_CASE("a Kinect's stamps hold where the host slept or its raw clock went back") {
  const FreshFolder folder;
  PosixFiles files;
  for (const double slept_s : {0.05, 2.0, 600.0, -0.1, -2.0}) {
    CAPTURE(slept_s);
    RecordedLab lab(20261123);
    lab.add_kinect({100.0, 20.0, 20.1, slept_s}, {7.0, -15.0, 20.1, slept_s}, 0.030, 40.0);
    const std::string path = folder.write("take.mcap", lab.file());
    const RecordedStream stream = opened(files, stream_named("kinect", path));
    const Errors errors = kinect_errors(stream);
    CHECK(errors.samples == 1200);
    CHECK(errors.least > 29.5);
    CHECK(errors.most < 31.5);
    CHECK(stream.survey.backward == 0);
  }
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
  CHECK(without.error().expected.find("or now in the manifest") != std::string::npos);
  options.skeleton = folder.write("suit.bvh", noitom_chain("Spine3", false));
  const RecordedStream stream = opened(files, options);
  CHECK(stream.files.size() == 2);  // hashed, too
  CHECK(std::get<ClipInput>(stream.data).skeleton.joints() == 59);
  CHECK(mocap_errors(stream).samples == 2500);
  options.name = "kinect";
  const auto of_kinect = open_streams(files, {options});
  REQUIRE(!of_kinect);
  CHECK(of_kinect.error().expected == "a skeleton of a noitom stream alone");
}
