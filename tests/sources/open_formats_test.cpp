// SPDX-License-Identifier: Apache-2.0
// Files of other programs, recognised by their contents: surveyed, hashed, read twice.
#include "tests/folder.h"
#include "tests/formats/any_points.h"
#include "tests/formats/bids/data_set.h"
#include "tests/formats/mvnx/mvnx_text.h"

#include "kinalign/formats/c3d/c3d.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

RecordedStream opened(const std::string& path,
                      const std::map<std::string, std::string>& select = {}) {
  static PosixFiles files;
  StreamOptions options;
  options.name = "some";
  options.files = {{path, ""}};
  options.select = select;
  auto recording = open_streams(files, {options});
  if (!recording) FAIL(to_string(recording.error()));
  return recording->streams.front();
}

/// The number of rows of one pass.
std::uint64_t rows_of(const RecordedStream& stream) {
  return std::visit(
      [](const auto& input) -> std::uint64_t {
        const auto pass = input.passes();
        if (!pass) FAIL(to_string(pass.error()));
        std::uint64_t rows = 0;
        auto block = [&] {
          if constexpr (std::is_same_v<std::decay_t<decltype(input)>, ClipInput>)
            return ClipFrames();
          else if constexpr (std::is_same_v<std::decay_t<decltype(input)>, PointInput>)
            return PointFrames();
          else
            return ImuSamples();
        }();
        for (;;) {
          const auto more = (*pass)(block);
          if (!more) FAIL(to_string(more.error()));
          if (!*more) return rows;
          rows += block.size();
        }
      },
      stream.data);
}

}  // namespace

TEST_CASE("a C3D is opened as points, counted by its rate") {
  std::mt19937_64 random(1);
  const PointStream points = any_points(3, 20, 100.0, 0, random);
  std::string bytes;
  auto writer =
      C3dWriter::begin({points.joint_names, 100.0, 20}, [&](std::string_view more) -> Result<void> {
        bytes += more;
        return {};
      });
  REQUIRE(writer);
  REQUIRE(writer->append(points.frames));
  REQUIRE(writer->finish());
  const FreshFolder folder;
  const RecordedStream stream = opened(folder.write("walk.c3d", bytes));
  CHECK(stream.format == "c3d");
  CHECK(stream.counted);
  CHECK(stream.survey.samples == 20);
  CHECK(stream.survey.median_step_ns == 10'000'000);
  CHECK(std::get<PointInput>(stream.data).joint_names == points.joint_names);
  CHECK(rows_of(stream) == 20);
  CHECK(rows_of(stream) == 20);
}

TEST_CASE("an MVNX is opened as a skeleton's motion, stamped by its own time of day") {
  const FreshFolder folder;
  const RecordedStream stream = opened(folder.write(
      "walk.mvnx", mvnx_of(upright("index=\"0\" ms=\"1542082631842\" type=\"normal\"", "0") +
                           upright("index=\"1\" type=\"normal\"", "0.5"))));
  CHECK(stream.format == "mvnx");
  CHECK(!stream.counted);
  CHECK(stream.survey.first == utc_time(1'542'082'631'842'000'000));
  CHECK(stream.survey.last == utc_time(1'542'082'631'852'000'000));
  CHECK(std::get<ClipInput>(stream.data).skeleton.joint_names ==
        std::vector<std::string>{"Pelvis", "Leg"});
  CHECK(rows_of(stream) == 2);
}

TEST_CASE("a tracking system of BIDS-Motion is opened with all files that say what it means") {
  const FreshFolder folder;
  for (const auto& [path, text] : bids_data_set(bids_streams(5))) folder.write(path, text);
  const std::string imu = folder / bids_path(bids_system("imu"), "motion.tsv");
  const RecordedStream nodes = opened(imu);
  CHECK(nodes.format == "bids");
  CHECK(nodes.files.size() ==
        5);  // motion.tsv, channels.tsv, motion.json, channels.json, scans.tsv
  CHECK(nodes.survey.first == utc_time(bids_start_ns));
  CHECK(std::get<ImuInput>(nodes.data).node_names == std::vector<std::string>{"waist", "wrist"});
  CHECK(rows_of(nodes) == 200);
  const std::string suit = folder / bids_path(bids_system("suit"), "motion.tsv");
  CHECK(std::holds_alternative<PointInput>(opened(suit).data));
  CHECK(std::holds_alternative<ImuInput>(opened(suit, {{"kind", "nodes"}}).data));
}
