// SPDX-License-Identifier: Apache-2.0
#include "tests/formats/any_points.h"
#include "tests/formats/reading.h"
#include "tests/formats/written_text.h"
#include "tests/seeds.h"
#include "tests/shared_data.h"
#include "tests/witness.h"

#include "kinalign/formats/points/trc.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

Result<std::string> trc_of(const PointStream& stream, const TrcHead& head) {
  return written_text([&](TextOut& out) -> Result<void> {
    auto writer = KA_TRY(TrcWriter::begin(head, out));
    KA_TRY(writer.append(stream.frames));
    return writer.finish();
  });
}

std::string refusal(const PointStream& stream, const TrcHead& head) {
  const auto text = trc_of(stream, head);
  return text ? "" : to_string(text.error());
}

Read<PointReader> read_again(std::string_view text, const StreamOptions& options = {}) {
  return read_in_pieces(make_trc_reader(options, "written.trc"), text, 1009);
}

}  // namespace

TEST_CASE("a TRC is written with its head, a row a frame and empty cells for a missing marker") {
  PointStream stream{{"HEAD", "R.TOE"}, {}};
  stream.frames.stamps = {utc_time(5'000'000'000), utc_time(5'010'000'001)};
  stream.frames.positions = {1, 2, -3, 0, 0, 0, 0, 0, 0, 0.1234567891, 0.2, 0.3};
  stream.frames.state = {Tracking::tracked, Tracking::missing, Tracking::missing,
                         Tracking::inferred};
  CHECK(
      trc_of(stream, {stream.joint_names, 100.0, 2, "walk.trc", utc_time(5'000'000'000)}).value() ==
      "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n"
      "100\t100\t2\t2\tmm\t100\t1\t2\n"
      "Frame#\tTime\tHEAD\t\t\tR.TOE\t\t\n"
      "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
      "\n"
      "1\t0\t1000.00000\t2000.00000\t-3000.00000\t\t\t\n"
      "2\t0.010000001\t\t\t\t123.45679\t200.00000\t300.00000\n");
}

TEST_CASE("points that were written as TRC are read again to 0.005 micrometres, stamps exactly") {
  for (const std::uint64_t seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    constexpr std::int64_t start_ns = 1'790'000'000'000'000'000;
    const std::size_t frames = 2 + random() % 60;
    const PointStream stream = any_points(1 + random() % 50, frames, 59.94, start_ns, random);
    const auto text =
        trc_of(stream, {stream.joint_names, 59.94, frames, "t.trc", utc_time(start_ns)});
    StreamOptions options;
    options.start_ns = start_ns;
    const auto read = read_again(text.value(), options);
    CHECK(read.error == "");
    CHECK(read.findings.empty());
    CHECK(read.header.joint_names == stream.joint_names);
    CHECK(read.rows.stamps == stream.frames.stamps);
    CHECK(read.rows.state == stream.frames.state);
    CHECK(largest_difference(read.rows.positions, stream.frames.positions) <= 5.1e-9);
  }
}

TEST_CASE("a reader that is as strict as OpenSim's finds in a written TRC what was given") {
  std::mt19937_64 random(7);
  const PointStream stream = any_points(17, 200, 120.0, 0, random);
  const FreshFolder folder;
  folder.write("written.trc",
               trc_of(stream, {stream.joint_names, 120.0, 200, "written.trc", {}}).value());
  put_points(folder, stream.frames);
  CHECK(run_witness("trc_read.py", folder.path()) == 0);
}

TEST_CASE("a real TRC is written again with the same values" * doctest::skip(!shared_data())) {
  const auto first = read_again(shared_text("points_trc/std_walking2_markers.trc"));
  REQUIRE(first.error == "");
  const PointStream stream{first.header.joint_names, first.rows};
  const auto again = read_again(
      trc_of(stream, {stream.joint_names, 250.0, first.rows.size(), "again", {}}).value());
  REQUIRE(again.findings.size() == 1);  // the file's times do not fit its DataRate
  CHECK(text_of(again.findings[0]) ==
        "written.trc:3: expected times of DataRate 250, found 25.04 frames per second");
  CHECK(again.rows.stamps == first.rows.stamps);
  CHECK(again.rows.state == first.rows.state);
  CHECK(largest_difference(again.rows.positions, first.rows.positions) <= 5.1e-9);
}

TEST_CASE("what a TRC can't hold is refused") {
  std::mt19937_64 random(7);
  const PointStream stream = any_points(2, 3, 100.0, 0, random);
  CHECK(refusal(stream, {{"A", "B"}, 100.0, 4, "", {}}) == "expected 4 frames for a TRC, found 3");
  CHECK(refusal(stream, {{"A", "B\tC"}, 100.0, 3, "", {}}) ==
        "expected names of markers for a TRC without tabs, found B?C");
  CHECK(refusal(stream, {{}, 100.0, 3, "", {}}) ==
        "expected at least one marker for a TRC, found none");
  CHECK(refusal(stream, {{"A", "B"}, 0.0, 3, "", {}}) == "expected a rate for a TRC, found 0");
}
