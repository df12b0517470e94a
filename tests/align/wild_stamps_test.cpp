// SPDX-License-Identifier: Apache-2.0
// Clocks that slip: the survey and the alignment must keep the same samples.
#include "tests/align/streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"
#include "kinalign/resample/window.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;
using namespace kinalign::test;

namespace {

AlignmentReport report_of(const std::vector<Time>& stamps) {
  Recording recording;
  recording.streams = {recorded("points", points({"a"}, every(10 * ms, 300), wander)),
                       recorded("kinect", points({"b"}, stamps, wander))};
  const auto take = align(recording, own_space());
  REQUIRE(take);
  return take->report;
}

}  // namespace

TEST_CASE("the samples a window holds are the ones that the survey counts") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<Time> stamps;
    std::int64_t now = 0;
    for (std::size_t i = 0; i < 60; ++i) {
      now += static_cast<std::int64_t>(random() % 40) * ms;
      const auto kind = random() % 12;
      const std::int64_t slip = kind == 0 ? 5000 * ms : kind == 1 ? -5000 * ms : 0;
      if (kind == 2) now += 3000 * ms;
      if (kind == 3) now -= 3000 * ms;
      stamps.push_back(utc_time(now + slip));
    }
    const PointStream all = points({"a"}, stamps, wander);
    StampSurveyor surveyor;
    surveyor.add(stamps);
    const StampSurvey survey = surveyor.result();
    const TimeModel clock;
    for (const std::size_t size : {1U, 7U, 60U}) {
      Window<PointFrames> window(in_blocks(all.frames, size), clock);
      REQUIRE(window.move(to_ns(survey.first), to_ns(survey.last), {1000, INT64_MAX}));
      CHECK(window.time_ns.size() == survey.kept());
      CHECK(window.rows.size() == survey.kept());
      CHECK(window.time_ns.front() == to_ns(survey.first));
      CHECK(window.time_ns.back() == to_ns(survey.last));
      for (std::size_t i = 1; i < window.time_ns.size(); ++i) {
        CHECK(window.time_ns[i] > window.time_ns[i - 1]);
      }
    }
  }
}

TEST_CASE("one wild stamp in a stream costs one sample of the take's neighbourhood") {
  auto stamps = every(30 * ms, 101);
  stamps[50] = utc_time(4'000'000'000'000'000'000);
  const auto report = report_of(stamps);
  CHECK(report.frames == 300);
  CHECK(report.streams[1].invalid == 0);
  REQUIRE(report.findings.size() == 1);
  CHECK(to_string(report.findings[0].what) ==
        "kinect: expected stamps without jumps, found 1 far ahead of their neighbours");
}

TEST_CASE("a clock set back by an hour is an error that says how many samples are lost") {
  auto stamps = every(30 * ms, 60, 3'600'000 * ms);
  for (const Time t : every(30 * ms, 101)) stamps.push_back(t);
  Recording recording;
  recording.streams = {
      recorded("points", points({"a"}, every(10 * ms, 300, 3'600'000 * ms), wander)),
      recorded("kinect", points({"b"}, stamps, wander))};
  const auto take = align(recording, own_space());
  REQUIRE(take);
  REQUIRE(take->report.findings.size() == 2);
  CHECK(take->report.findings[1].what.expected ==
        "all frames of 'points' within the common time of all streams");
  CHECK(take->report.findings[0].severity == Severity::error);
  CHECK(to_string(take->report.findings[0].what) ==
        "kinect: expected rising stamps, found 101 of 161 that step back, by up to 3601.770 s");
}

TEST_CASE("a gap of the reference between two blocks is counted") {
  auto stamps = every(10 * ms, 2048);
  for (const Time t : every(10 * ms, 100, 30'000 * ms)) stamps.push_back(t);
  const PointStream all = points({"a"}, stamps, wander);
  const RecordedStream reference = read_in_blocks(recorded("points", all), all.frames, 2048);
  Recording recording;
  recording.streams = {reference};
  const auto take = align(recording, {});
  REQUIRE(take);
  CHECK(take->report.streams[0].gaps == 1);
}
