// SPDX-License-Identifier: Apache-2.0
// The same messages in chunks of other sizes are the same recording.
#include "tests/align/same_take.h"
#include "tests/counting_files.h"
#include "tests/folder.h"
#include "tests/recording/recorded_lab.h"
#include "tests/recording/survey_recording.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"
#include "kinalign/recording/survey.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// A node, a Kinect and mocap. Nine of every 60 messages arrive 0.2 s late. The recording computer
/// sleeps for `slept_s`.
RecordedLab troubled_lab(std::uint64_t seed, double slept_s) {
  RecordedLab lab(seed);
  RecordedLab::Counter sensor{100.0, 20.0}, sender{7.0, -15.0};
  if (slept_s > 0.0) sensor.sleep_at_s = sender.sleep_at_s = 10.0;
  sensor.slept_s = sender.slept_s = slept_s;
  lab.add_mocap(NoitomForm::new_header, "udp", 20.0);
  lab.add_kinect(sensor, sender, 0.030, 20.0);
  lab.add_node(12, 1, {3.0, 10.0}, 0.1, 19.0);
  lab.hold_back(60, 0.2, 8);
  return lab;
}

/// Aligns take.mcap of the folder onto the stream named, or the first.
Take aligned(FileSystem& files, const FreshFolder& folder, const std::string& reference) {
  const std::string path = folder / "take.mcap";
  const auto survey = survey_recording(files, path);
  REQUIRE(survey);
  auto manifest = manifest_of(*survey, "take.mcap");
  REQUIRE(manifest);
  manifest->spaces["kinect"].method = "none";
  manifest->align.reference = reference;
  const auto recording = open_recording(files, *manifest, folder.path() + "/");
  REQUIRE(recording);
  auto take = align(*recording, *manifest);
  if (!take) FAIL(to_string(take.error()));
  return *std::move(take);
}

Take aligned(const std::string& bytes) {
  const FreshFolder folder;
  PosixFiles files;
  folder.write("take.mcap", bytes);
  return aligned(files, folder, "");
}

}  // namespace

TEST_CASE("a take does not depend on the size of its recording's chunks") {
  for (const auto seed : fresh_seeds(3)) {
    for (const double slept_s : {0.0, 3.0, 30.0}) {
      CAPTURE(seed);
      CAPTURE(slept_s);
      RecordedLab lab = troubled_lab(seed, slept_s);
      RecordedLab::Part whole, small, large;
      small.chunk_s = 0.002;
      large.chunk_s = 1e9;
      const Take take = aligned(lab.file(whole));
      check_same(aligned(lab.file(small)), take);
      check_same(aligned(lab.file(large)), take);
    }
  }
}

TEST_CASE("whatever stream is the reference, a recording is read thrice at most") {
  const FreshFolder folder;
  RecordedLab lab(20261126);
  const double seconds = 500.0;  // more than the cache holds (recording/streams/stored_chunks.h)
  lab.add_mocap(NoitomForm::new_header, "udp", seconds, 0, "10.0.0.3:7012", true);
  lab.add_kinect({100.0, 20.0}, {7.0, -15.0}, 0.030, seconds);
  lab.add_node(12, 1, {3.0, 10.0}, 0.1, seconds, "", 50.0);
  const std::string bytes = lab.file();
  folder.write("take.mcap", bytes);
  for (const std::string reference : {"mocap", "kinect"}) {
    CAPTURE(reference);
    CountingFiles files;
    const Take take = aligned(files, folder, reference);
    CHECK(take.report.frames > 14'000);
    CHECK(static_cast<double>(files.bytes) < 3.2 * static_cast<double>(bytes.size()));
    CHECK(static_cast<double>(files.bytes) > 1.5 * static_cast<double>(bytes.size()));
  }
}
