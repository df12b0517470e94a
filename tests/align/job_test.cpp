// SPDX-License-Identifier: Apache-2.0
// How a take is passed on: the header first, then slabs in order, the same on one thread and on
// two, and an end when the receiver asks for it.
#include "tests/align/two_streams.h"

#include "kinalign/align/align.h"
#include "kinalign/align/slabs.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// A recording whose take has more than three slabs.
const Recording& long_recording() {
  static const Recording recording = two(points(joints, every(10 * ms, 7000), wander),
                                         points(joints, every(30 * ms, 2334), wander));
  return recording;
}

Manifest fitted() {
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  return manifest;
}

/// A receiver that ends the job after `most` calls and remembers the calls.
struct Watched {
  std::size_t most = SIZE_MAX;
  std::vector<std::string> told;
  std::uint64_t done = 0, total = 0;
  bool rises = true;

  Progress progress() {
    return [this](std::string_view what, std::uint64_t at, std::uint64_t of) {
      if (!told.empty() && told.back() == what) rises = rises && at >= done;
      told.emplace_back(what);
      done = at;
      total = of;
      return told.size() < most;
    };
  }
};

TakeSink nowhere() {
  return {[](const TakeHeader&) -> Result<void> { return {}; },
          [](const TakeSlab&) -> Result<void> { return {}; }};
}

}  // namespace

TEST_CASE("the header comes first, then slabs of at most 2048 rows, each behind the last") {
  std::uint64_t headers = 0, rows = 0;
  TakeSink sink;
  sink.begin = [&](const TakeHeader& header) -> Result<void> {
    ++headers;
    CHECK(rows == 0);
    CHECK(header.frames == 7000);
    return {};
  };
  sink.rows = [&](const TakeSlab& slab) -> Result<void> {
    CHECK(headers == 1);
    CHECK(slab.first == rows);
    CHECK(slab.stamps.size() <= slab_rows);
    CHECK(!slab.stamps.empty());
    rows += slab.stamps.size();
    return {};
  };
  REQUIRE(align(long_recording(), fitted(), sink));
  CHECK(headers == 1);
  CHECK(rows == 7000);
}

TEST_CASE("two threads make the rows that one makes") {
  std::vector<std::vector<double>> all;
  for (const std::size_t jobs : {std::size_t{1}, std::size_t{2}, std::size_t{7}}) {
    auto& numbers = all.emplace_back();
    TakeSink sink = nowhere();
    sink.rows = [&](const TakeSlab& slab) -> Result<void> {
      for (const auto& rows : slab.rows) {
        const auto& positions = std::get<PointRows>(rows).positions;
        numbers.insert(numbers.end(), positions.begin(), positions.end());
      }
      return {};
    };
    const auto report = align(long_recording(), fitted(), sink, {}, jobs);
    REQUIRE(report);
    numbers.push_back(report->spaces.at(0).after_m);
  }
  CHECK(all[0] == all[1]);
  CHECK(all[0] == all[2]);
}

TEST_CASE("progress is reported for the fit, then for the rows, up to the last row") {
  Watched watched;
  REQUIRE(align(long_recording(), fitted(), nowhere(), watched.progress()));
  CHECK(watched.rises);
  CHECK(watched.told.front() == "fitting");
  CHECK(watched.told.back() == "aligning");
  CHECK(watched.done == 7000);
  CHECK(watched.total == 7000);
}

TEST_CASE("a stopped job ends with an interruption, in the fit and in the rows") {
  for (const std::size_t calls : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    CAPTURE(calls);
    Watched watched;
    watched.most = calls;
    const auto report = align(long_recording(), fitted(), nowhere(), watched.progress());
    REQUIRE_FALSE(report);
    CHECK(to_string(report.error()) == "expected the end of the job, found an interruption");
    CHECK(watched.told.size() == calls);
  }
}

TEST_CASE("an error of the sink ends the job unchanged") {
  const Failure full(Error{"take.h5", 0, "room on the disk", "none"});
  TakeSink sink = nowhere();
  sink.begin = [&](const TakeHeader&) -> Result<void> { return full; };
  sink.rows = [](const TakeSlab&) -> Result<void> {
    FAIL("rows without a header");
    return {};
  };
  CHECK(to_string(align(long_recording(), {}, sink).error()) ==
        "take.h5: expected room on the disk, found none");
  sink = nowhere();
  std::size_t slabs = 0;
  sink.rows = [&](const TakeSlab&) -> Result<void> { return ++slabs == 2 ? full : Result<void>(); };
  CHECK(to_string(align(long_recording(), {}, sink).error()) ==
        "take.h5: expected room on the disk, found none");
  CHECK(slabs == 2);
}

TEST_CASE("a stream that can't be read again is the job's error") {
  Recording recording = long_recording();
  std::get<PointInput>(recording.streams[1].data).passes = []() -> Result<Pass<PointFrames>> {
    return Failure(Error{"k.csv", 0, "a readable file", "none"});
  };
  CHECK(to_string(align(recording, {}, nowhere()).error()) ==
        "k.csv: expected a readable file, found none");
}

TEST_CASE("findings come with the worst first, the readers' under their files' names alone") {
  Recording recording = long_recording();
  recording.streams[0].findings = {{Severity::note, {"/a/b/walk.bvh", 3, "a", "b"}, "", ""}};
  recording.streams[1].findings = {{Severity::error, {"/c/k.csv", 0, "c", "d"}, "", ""},
                                   {Severity::warning, {"k.csv", 0, "e", "f"}, "", ""}};
  const auto report = align(recording, own_space(), nowhere());
  REQUIRE(report);
  std::vector<std::string> texts;
  for (const Finding& finding : report->findings) texts.push_back(to_string(finding.what));
  CHECK(texts == std::vector<std::string>{"k.csv: expected c, found d",
                                          "k.csv: expected e, found f",
                                          "walk.bvh:3: expected a, found b"});
}
