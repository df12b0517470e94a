// SPDX-License-Identifier: Apache-2.0
// The first pass over a recording's files, and every later one: hashes, clocks, and the check that
// a file has not changed.
#include "tests/folder.h"

#include "kinalign/core/hash.h"
#include "kinalign/sources/open_recording.h"

#include <doctest/doctest.h>

#include <set>
#include <thread>

using namespace kinalign;

namespace {

const std::string head = "time_ns,qw,qx,qy,qz\n";

StreamOptions nodes(std::vector<StreamFile> files) {
  StreamOptions out;
  out.name = "imu";
  out.layout = "imu";
  out.files = std::move(files);
  return out;
}

std::string rows_from(std::int64_t first, int count) {
  std::string text = head;
  for (int i = 0; i < count; ++i) text += std::to_string(first + i * 10) + ",1,0,0,0\n";
  return text;
}

/// Reads all rows of one pass; gives their number, or the error.
Result<std::size_t> pass_over(const RecordedStream& stream) {
  auto pass = KA_TRY(std::get<ImuInput>(stream.data).passes());
  ImuSamples block;
  std::size_t rows = 0;
  while (KA_TRY(pass(block))) rows += block.size();
  return rows;
}

std::string error_of(const Result<Recording>& streams) {
  return streams ? "none" : to_string(streams.error());
}

RecordedStream one_stream(FileSystem& files, const StreamOptions& options) {
  auto streams = open_streams(files, {options});
  REQUIRE_MESSAGE(streams, error_of(streams));
  REQUIRE(streams->streams.size() == 1);
  return streams->streams.front();
}

}  // namespace

TEST_CASE("a stream knows its file's hash, size and stamps, and can be read again and again") {
  const FreshFolder folder;
  const std::string text = rows_from(100, 1000);
  const std::string path = folder.write("w.csv", text);
  PosixFiles files;
  const RecordedStream stream = one_stream(files, nodes({{path, "waist"}}));
  REQUIRE(stream.files.size() == 1);
  CHECK(stream.files[0].name == "w.csv");
  CHECK(stream.files[0].bytes == text.size());
  Sha256 hash;
  hash.update(text);
  CHECK(stream.files[0].sha256 == hash.hex());
  CHECK(stream.survey.samples == 1000);
  CHECK(stream.survey.first == utc_time(100));
  CHECK(stream.survey.last == utc_time(100 + 9990));
  CHECK(stream.survey.median_step_ns == 10);
  CHECK(std::get<ImuInput>(stream.data).node_names == std::vector<std::string>{"waist"});
  CHECK(pass_over(stream) == 1000U);
  CHECK(pass_over(stream) == 1000U);
}

TEST_CASE("a file that changed since its hash was taken is not read again") {
  const FreshFolder folder;
  const std::string path = folder.write("w.csv", rows_from(100, 5));
  PosixFiles files;
  const RecordedStream stream = one_stream(files, nodes({{path, "waist"}}));
  CHECK(pass_over(stream) == 5U);
  folder.write("w.csv", rows_from(100, 6));
  const auto again = pass_over(stream);
  REQUIRE_FALSE(again);
  CHECK(to_string(again.error()) ==
        path + ": expected a file that does not change while it is read, found a changed file");
}

TEST_CASE("what is known of a clock comes from the options, counted from the first stamp") {
  const FreshFolder folder;
  const std::string path = folder.write("w.csv", rows_from(5'000, 5));
  PosixFiles files;
  StreamOptions options = nodes({{path, "waist"}});
  const auto piece = [&] {
    const TimeModel clock = one_stream(files, options).clock;
    REQUIRE(clock.pieces.size() == 1);
    return clock.pieces.front();
  };
  CHECK_FALSE(piece().half_width);
  options.clock = "shared";
  CHECK(piece().half_width == Duration{0});
  options.clock = "unknown";
  options.offset_ms = -1.5;
  options.drift_ppm = 20.0;
  options.interval_ms = 0.25;
  const TimeModelPiece stated = piece();
  CHECK(stated.begin == utc_time(5'000));
  CHECK(stated.offset == Duration{-1'500'000});
  CHECK(stated.drift_ppm == 20.0);
  CHECK(stated.half_width == Duration{250'000});
}

TEST_CASE("a stream without a file, without the file and without rows") {
  const FreshFolder folder;
  PosixFiles files;
  CHECK(error_of(open_streams(files, {nodes({})})) ==
        "expected a file for stream 'imu', found none");
  const std::string absent = folder / "none.csv";
  CHECK(error_of(open_streams(files, {nodes({{absent, ""}})})) ==
        absent + ": expected a readable file, found No such file or directory");
  const std::string empty = folder.write("empty.csv", "");
  CHECK(error_of(open_streams(files, {nodes({{empty, ""}})})) ==
        empty + ": expected a table of layout imu, found the end of the file");
  const std::string only_head = folder.write("head.csv", head);
  const RecordedStream none = one_stream(files, nodes({{only_head, ""}}));
  CHECK(none.survey.samples == 0);
  CHECK(pass_over(none) == 0U);
}

TEST_CASE("files read side by side give what one after the other gives, the first fault too") {
  const FreshFolder folder;
  PosixFiles files;
  std::vector<StreamFile> named;
  for (int i = 0; i < 9; ++i) {
    const std::string node = "n" + std::to_string(i);
    named.push_back({folder.write(node + ".csv", rows_from(i, 10 + i)), node});
  }
  const auto one = open_streams(files, {nodes(named)}, {{}, 1});
  const auto four = open_streams(files, {nodes(named)}, {{}, 4});
  REQUIRE(one);
  REQUIRE(four);
  REQUIRE(one->streams.size() == 9);
  REQUIRE(four->streams.size() == 9);
  for (std::size_t i = 0; i < 9; ++i) {
    CHECK(std::get<ImuInput>(four->streams[i].data).node_names ==
          std::vector<std::string>{"n" + std::to_string(i)});
    CHECK(four->streams[i].files[0].sha256 == one->streams[i].files[0].sha256);
    CHECK(four->streams[i].survey.samples == 10 + i);
  }
  folder.write("n3.csv", head + "x,1,0,0,0\n");
  folder.write("n7.csv", "no head\n");
  for (const std::size_t jobs : {std::size_t{1}, std::size_t{4}}) {
    CHECK(error_of(open_streams(files, {nodes(named)}, {{}, jobs})) ==
          (folder / "n3.csv") + ":2: expected a stamp inside +-4e18 ns, found x");
  }
}

TEST_CASE("progress rises to all files' bytes, and stops the job when it says so") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string one = folder.write("a.csv", rows_from(0, 5)),
                    other = folder.write("b.csv", rows_from(0, 7));
  const std::vector<StreamOptions> streams{nodes({{one, "a"}, {other, "b"}})};
  std::uint64_t last = 0;
  bool rises = true;
  const Progress count = [&](std::string_view what, std::uint64_t done, std::uint64_t) {
    rises = rises && what == "reading" && done >= last;
    last = done;
    return true;
  };
  REQUIRE(open_streams(files, streams, {count}));
  CHECK(rises);
  CHECK(last == folder.read("a.csv").size() + folder.read("b.csv").size());
  const Progress stop = [](std::string_view, std::uint64_t, std::uint64_t) { return false; };
  const auto stopped = open_streams(files, streams, {stop});
  REQUIRE_FALSE(stopped);
  CHECK(stopped.error().file == one);
}

TEST_CASE("a table's start_ns and a BVH's are the first row's stamp") {
  const FreshFolder folder;
  PosixFiles files;
  StreamOptions options = nodes({{folder.write("w.csv", rows_from(5'000, 5)), "waist"}});
  options.start_ns = 77;
  const RecordedStream table = one_stream(files, options);
  CHECK(table.survey.first == utc_time(77));
  CHECK(table.survey.last == utc_time(117));
  CHECK_FALSE(table.step_ns);
  StreamOptions bvh;
  bvh.name = "mocap";
  bvh.start_ns = 77;
  bvh.files = {{folder.write("a.bvh",
                             "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\n"
                             "Frames: 3\nFrame Time: 0.01\n1\n2\n3\n"),
                ""}};
  const RecordedStream clip = one_stream(files, bvh);
  CHECK(clip.survey.first == utc_time(77));
  CHECK(clip.survey.last == utc_time(20'000'077));
  CHECK(clip.step_ns == 1e7);
}
