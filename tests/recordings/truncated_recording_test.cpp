// SPDX-License-Identifier: Apache-2.0
// A recording of several devices that breaks off or is damaged, aligned.
#include "tests/folder.h"
#include "tests/recording/recorded_lab.h"
#include "tests/recording/survey_recording.h"

#include "kinalign/align/align.h"
#include "kinalign/recording/streams/recording_source.h"
#include "kinalign/recording/survey.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

/// Two nodes, a Kinect and mocap for ten seconds.
RecordedLab four_streams() {
  RecordedLab lab(20261123);
  lab.add_node(12, 1, {3.0, -35.0}, 0.0, 10.0);
  lab.add_node(13, 1, {4.0, 10.0}, 0.0, 10.0);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, 10.0);
  lab.add_mocap(NoitomForm::new_header, "udp", 10.0);
  return lab;
}

/// The warnings from aligning the whole recording. `further`: the bytes of its second file.
std::vector<std::string> warnings(const std::string& bytes, const std::string& further = "") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder.write("take.mcap", bytes);
  if (!further.empty()) folder.write("take.part2.mcap", further);
  const auto survey = survey_recording(files, path);
  REQUIRE(survey);
  auto manifest = manifest_of(*survey, "take.mcap");
  REQUIRE(manifest);
  manifest->spaces["kinect"] = {};
  manifest->spaces["kinect"].method = "none";
  const auto recording = open_recording(files, *manifest, folder.path() + "/");
  REQUIRE(recording);
  REQUIRE(recording->streams.size() == 4);
  const auto take = align(*recording, *manifest);
  if (!take) FAIL(to_string(take.error()));
  std::vector<std::string> out;
  for (const Finding& finding : take->report.findings) {
    if (finding.severity == Severity::note) continue;
    out.push_back(to_string(finding.what));
  }
  return out;
}

}  // namespace

TEST_CASE("a recording that breaks off is said to once, however many streams are read from it") {
  const std::string whole = four_streams().file(false);
  const auto told = warnings(whole.substr(0, 7 * whole.size() / 10));
  const std::string torn = "take.mcap: expected a file that was closed, found a truncated file";
  CHECK(std::count(told.begin(), told.end(), torn) == 1);
  for (const std::string& text : told) {
    INFO(text);
    CHECK(std::count(told.begin(), told.end(), text) == 1);
  }
}

TEST_CASE("of a recording in two files nothing is amiss, however many nodes are in both") {
  RecordedLab lab = four_streams();
  const auto whole = warnings(lab.file());
  CHECK(warnings(lab.file({1, -1e9, 6.0}), lab.file({2, 5.5, 1e9})) == whole);
}

TEST_CASE("damage is told once, and of each stream what it has lost by it") {
  std::string bytes = four_streams().file(false);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  const auto told = warnings(bytes);
  for (const std::string stream : {"mocap", "kinect", "imu 12", "imu 13"}) {
    CAPTURE(stream);
    CHECK(std::count_if(told.begin(), told.end(), [&stream](const std::string& text) {
            return text.find("every message that reached the recorder in '" + stream + "'") !=
                   std::string::npos;
          }) == 1);
  }
  for (const std::string& text : told) {
    INFO(text);
    CHECK(std::count(told.begin(), told.end(), text) == 1);
  }
}
