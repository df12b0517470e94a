// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/recording_source.h"

#include "tests/counting_files.h"
#include "tests/recording/streams/recorded_streams.h"
#include "tests/recording/survey_recording.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

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
  // A known delay is subtracted.
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
    const RecordedStream stream = opened(files, stream_named("mocap", path));
    CHECK(says_arrivals(stream) == (transport == "udp"));
    const Errors errors = mocap_errors(stream);
    CHECK(errors.samples == 5000);
    CHECK(errors.certified == 0);
    CHECK(errors.least > 0.2);
    if (transport == "tcp") CHECK(errors.most < 1.0);
    if (transport == "udp") CHECK(errors.most > 4.0);
  }
}

TEST_CASE("frames without a number that come in one datagram are a step apart") {
  const FreshFolder folder;
  PosixFiles files;
  for (const NoitomForm form : {NoitomForm::old_header, NoitomForm::text}) {
    RecordedLab lab(20261123);
    lab.add_mocap(form, "udp", 20.0);
    lab.join_pairs();
    const RecordedStream stream =
        opened(files, stream_named("mocap", folder.write("take.mcap", lab.file())));
    CHECK(stream.survey.samples == 2500);
    CHECK(stream.survey.kept() == 2500);
    CHECK(stream.survey.median_step_ns > 7'900'000);
    CHECK(stream.survey.median_step_ns < 8'100'000);
    const Errors errors = mocap_errors(stream);
    CHECK(errors.samples == 2500);
    CHECK(errors.least > 0.2);
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
    lab.hold_back(9, xsens ? 0.04 : 0.03);  // up to four later ones overtake it
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

TEST_CASE("frames of a Kinect that were overtaken in the network stand where they belong") {
  const FreshFolder folder;
  RecordedLab lab(20261123);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 40.0);
  lab.hold_back(9, 0.1);  // up to three later ones overtake it
  PosixFiles files;
  const RecordedStream stream =
      opened(files, stream_named("kinect", folder.write("take.mcap", lab.file())));
  CHECK(stream.survey.backward == 0);
  CHECK(stream.survey.kept() == 1200);
  const Errors errors = kinect_errors(stream);
  CHECK(errors.samples == 1200);
  CHECK(errors.least > 29.5);
  CHECK(errors.most < 31.5);
}

TEST_CASE("a boot after 256 restarts is no boot of another epoch of the host") {
  constexpr BootKey boot = 7, restarts = 256;
  CHECK(boot_in_epoch(boot | restarts << 32U, 0) != boot_in_epoch(boot, 1));
}

TEST_CASE("samples whose time steps back where a clock begins anew are told and counted") {
  const FreshFolder folder;
  PosixFiles files;
  RecordedLab lab(20261126);
  lab.add_kinect({100.0, 20.0, 10.0, 3.0}, {7.0, -15.0, 10.0, 3.0}, 0.030, 20.0);
  lab.mistake_epoch(10.2, 11.2);
  const RecordedStream stream =
      opened(files, stream_named("kinect", folder.write("take.mcap", lab.file())));
  std::int64_t last = INT64_MIN;
  std::uint64_t rising = 0;
  for (const Time stamp : *stream.stamps) {
    const std::int64_t t = to_ns(take_time(stream.clock, stamp));
    if (t <= last) continue;
    last = t;
    ++rising;
  }
  const std::uint64_t back = stream.survey.kept() - rising;
  CHECK(back > 0);
  const auto told = warnings(stream);
  CHECK(std::count_if(told.begin(), told.end(), [&](const std::string& text) {
          return text.find("samples with rising times, found " + std::to_string(back) +
                           " that step back") != std::string::npos;
        }) == 1);
}

TEST_CASE("rows that too many have overtaken are left out, never out of order, and that is told") {
  const FreshFolder folder;
  PosixFiles files;
  struct Held {
    std::string stream, expected;
    std::uint64_t rows;
  };
  for (const Held& held : {Held{"kinect", "frames that arrive after at most 16 newer ones", 1200},
                           Held{"mocap", "frames that arrive after at most 16 newer ones", 2500},
                           Held{"imu", "samples that arrive after at most 64 newer ones", 1200}}) {
    CAPTURE(held.stream);
    RecordedLab lab(20261123);
    if (held.stream == "kinect") lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 40.0);
    if (held.stream == "mocap") lab.add_mocap(NoitomForm::new_header, "udp", 20.0);
    if (held.stream == "imu") lab.add_node(12, 1, {3.0, -35.0}, 0.0, 40.0);
    lab.hold_back(300, 3.0, held.stream == "imu" ? 1 : 0);  // a node's exchange with its frame
    const RecordedStream stream =
        opened(files, stream_named(held.stream, folder.write("take.mcap", lab.file())));
    CHECK(stream.survey.backward == 0);
    const std::uint64_t lacks = held.rows - stream.survey.samples;
    CHECK(lacks > 0);
    CHECK(lacks <= 16);
    const auto told = std::find_if(
        stream.findings.begin(), stream.findings.end(),
        [&](const Finding& finding) { return finding.what.expected == held.expected; });
    REQUIRE(told != stream.findings.end());
    CHECK(told->severity == Severity::warning);
    CHECK(told->what.found == std::to_string(lacks) + " that arrived later");
    CHECK(told->meaning == "they were left out");
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
    const Findings of_file = opened_file(files, stream_named("imu", path)).findings;
    const auto torn = std::count_if(of_file.begin(), of_file.end(), [](const Finding& f) {
      return f.repair == "kinalign recover makes a complete file of it";
    });
    CHECK(torn == 1);
    const Errors errors = node_errors(stream);
    CHECK(errors.outside == 0);
    CHECK(static_cast<double>(errors.samples) > 300.0 * (share - 0.1));
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
  REQUIRE(streams->streams.size() == 2);
  for (const RecordedStream& stream : streams->streams) {
    CHECK(stream.findings.size() == 1);
    CHECK(says_arrivals(stream));
    CHECK(std::get<ImuInput>(stream.data).content == ImuContent{true, true, false, false});
    const Errors errors = node_errors(stream);
    CHECK(errors.samples == 2000);
    CHECK(errors.certified == 0);
    CHECK(errors.least > 1.4);
  }
  CHECK(std::get<ImuInput>(streams->streams.back().data).node_names ==
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
  CHECK(node_errors(stream).samples == 2001);  // nothing gives away the forged packet's own sample
  CHECK(stream.findings.size() == 1);
  CHECK(says_arrivals(stream));
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

namespace {

/// Mocap, a Kinect and five nodes.
std::string seven_devices(const FreshFolder& folder, double seconds) {
  RecordedLab lab(20261126);
  lab.add_mocap(NoitomForm::new_header, "udp", seconds, 50);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, seconds);
  for (std::uint32_t id = 1; id <= 5; ++id) lab.add_node(id, id, {3.0 * id, 5.0}, 0.1, seconds);
  lab.hold_back(97, 0.03);
  return folder.write("take.mcap", lab.file());
}

/// The manifest's streams for all devices of the recording.
std::vector<StreamOptions> all_streams(FileSystem& files, const std::string& path) {
  return manifest_of(*survey_recording(files, path), path)->streams;
}

template <class Frames>
std::vector<Time> stamps_of(const Passes<Frames>& passes) {
  const auto pass = passes();
  REQUIRE(pass);
  std::vector<Time> stamps;
  Frames block;
  for (;;) {
    const auto more = (*pass)(block);
    REQUIRE(more);
    if (!*more) return stamps;
    stamps.insert(stamps.end(), block.stamps.begin(), block.stamps.end());
  }
}

}  // namespace

TEST_CASE("a recording of seven devices is read once to open all of its streams") {
  const FreshFolder folder;
  const std::string path = seven_devices(folder, 60.0);
  const auto size = static_cast<double>(folder.read("take.mcap").size());
  PosixFiles plain;
  const auto streams = all_streams(plain, path);
  CountingFiles files;
  const auto recording = open_streams(files, streams);
  REQUIRE(recording);
  CHECK(recording->streams.size() == 7);
  // The file's head and first rows are read, too.
  CHECK(static_cast<double>(files.bytes) < 1.1 * size);
  files.bytes = 0;
  REQUIRE(read_through(*recording));
  CHECK(static_cast<double>(files.bytes) < 1.05 * size);  // the file is read once for all seven
}

TEST_CASE("the stamps that opening a recording foretells are those of its rows, in every pass") {
  const FreshFolder folder;
  const std::string path = seven_devices(folder, 20.0);
  PosixFiles files;
  const auto recording = open_streams(files, all_streams(files, path));
  REQUIRE(recording);
  for (const RecordedStream& stream : recording->streams) {
    CAPTURE(stream_label(stream));
    const auto stamps = [&] {
      return std::visit([](const auto& input) { return stamps_of(input.passes); }, stream.data);
    };
    const std::vector<Time> first = stamps();
    CHECK(stamps() == first);
    StampSurveyor surveyor;
    surveyor.add(first);
    CHECK(stream.survey.samples == first.size());
    CHECK(stream.survey.kept() == surveyor.result().kept());
    CHECK(stream.survey.last == surveyor.result().last);
    CHECK(stream.survey.median_step_ns == surveyor.result().median_step_ns);
    if (stream.stamps) CHECK(*stream.stamps == first);
  }
}

TEST_CASE("a recording that changes after it was opened is read no further") {
  const FreshFolder folder;
  const std::string path = seven_devices(folder, 20.0);
  PosixFiles files;
  const auto recording = open_streams(files, {stream_named("mocap", path)});
  REQUIRE(recording);
  std::string bytes = folder.read("take.mcap");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  folder.write("take.mcap", bytes);
  const auto read = read_through(*recording);
  REQUIRE_FALSE(read);
  CHECK(read.error().found == "a changed file");
}

TEST_CASE("a second pass over a recording says how far it is, and stops when it is told to") {
  const FreshFolder folder;
  RecordedLab lab(20261126);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 20.0);
  const std::string path = folder.write("take.mcap", lab.file());
  PosixFiles files;
  const auto source = RecordingSource::open(files, path, RecordingSource::Devices::surveyed);
  REQUIRE(source);
  const StreamOptions kinect = stream_named("kinect", path);
  std::uint64_t calls = 0;
  const Progress count = [&calls](std::string_view, std::uint64_t done, std::uint64_t all) {
    CHECK(done <= all);
    ++calls;
    return true;
  };
  CHECK((*source)->stream(kinect, kinect.files.front(), count));
  CHECK(calls > 10);  // chunks of half a second
  const Progress stop = [](std::string_view, std::uint64_t, std::uint64_t) { return false; };
  const auto stopped = (*source)->stream(kinect, kinect.files.front(), stop);
  REQUIRE_FALSE(stopped);
  CHECK(is_interruption(stopped.error()));
}
