// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/align.h"

#include "tests/align/two_streams.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace kinalign::test;

TEST_CASE("a take is cut to the span that all streams share, on the reference's own stamps") {
  const auto take = align(two(points(joints, every(10 * ms, 101), wander),
                              points(joints, every(33 * ms, 20, 207 * ms), wander)),
                          {});
  REQUIRE(take);
  CHECK(to_ns(take->all.stamps.front()) == 210 * ms);
  CHECK(to_ns(take->all.stamps.back()) == 830 * ms);  // 207 + 19 * 33 = 834
  CHECK(take->header.frames == 63);
  CHECK(take->report.frames == 63);
  CHECK(take->report.rate_hz == doctest::Approx(100.0).epsilon(0.01));
}

TEST_CASE("a smooth motion is given back between its samples, and exactly at them") {
  const auto take = align(
      two(points(joints, every(10 * ms, 400), wander), points(joints, every(30 * ms, 134), wander)),
      {});
  REQUIRE(take);
  const PointRows& kinect = rows(*take, 1);
  for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
    const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
    // The natural splines are flat at their ends.
    const bool inner = r > 30 && r + 30 < take->all.stamps.size();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double off = (at(kinect, r, j) - wander(j, t)).norm();
      CHECK(off < (r % 3 == 0 ? 1e-12 : inner ? 2e-6 : 2e-3));
      CHECK(kinect.valid[r * joints.size() + j] == 1);
      CHECK(kinect.state[r * joints.size() + j] == Tracking::tracked);
    }
    CHECK(kinect.distance.nearest_raw_ns[r] == (r % 3 == 0 ? 0 : 10 * ms));
  }
}

TEST_CASE("across a gap nothing is invented: samples are there, invalid and zero") {
  auto stamps = every(30 * ms, 100);
  stamps.erase(stamps.begin() + 40, stamps.begin() + 50);  // 1170 ms .. 1500 ms
  const auto take =
      align(two(points(joints, every(10 * ms, 298), wander), points(joints, stamps, wander)), {});
  REQUIRE(take);
  const PointRows& kinect = rows(*take, 1);
  for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
    const bool in_gap = r > 117 && r < 150;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const std::size_t cell = r * joints.size() + j;
      CHECK(kinect.valid[cell] == (in_gap ? 0 : 1));
      CHECK((at(kinect, r, j) == Vec3::Zero()) == in_gap);
      if (in_gap) CHECK(kinect.state[cell] == Tracking::missing);
    }
  }
  CHECK(take->report.streams[1].gaps == 1);
  CHECK(take->report.streams[1].gap_time_ns == 330 * ms);
  CHECK(take->report.streams[1].invalid == 32 * joints.size());
}

TEST_CASE("a gap of just three steps is bridged, a longer one is not") {
  for (const std::size_t lost : {std::size_t{2}, std::size_t{3}}) {
    auto stamps = every(30 * ms, 100);
    stamps.erase(stamps.begin() + 40, stamps.begin() + 40 + static_cast<std::ptrdiff_t>(lost));
    const auto take =
        align(two(points(joints, every(10 * ms, 298), wander), points(joints, stamps, wander)), {});
    REQUIRE(take);
    CHECK((take->report.streams[1].invalid == 0) == (lost == 2));
  }
}

TEST_CASE("a joint's spline does not run through samples that were not seen") {
  auto kinect = points(joints, every(30 * ms, 100), wander);
  const std::size_t hand = 2, frame = 50;
  kinect.frames.state[frame * joints.size() + hand] = Tracking::missing;
  for (int k = 0; k < 3; ++k)
    kinect.frames.positions[(frame * joints.size() + hand) * 3 + static_cast<std::size_t>(k)] = 0.0;
  const auto take = align(two(points(joints, every(10 * ms, 298), wander), kinect), {});
  REQUIRE(take);
  const PointRows& out = rows(*take, 1);
  for (std::size_t r = 148; r <= 152; ++r) {  // around 1500 ms
    const std::size_t cell = r * joints.size() + hand;
    const double t = 0.01 * static_cast<double>(r);
    CHECK((at(out, r, hand) - wander(hand, t)).norm() < 1e-4);
    CHECK(out.valid[cell] == 1);
    CHECK(out.state[cell] == Tracking::missing);
    CHECK(out.state[cell + 1] == Tracking::tracked);
  }
  CHECK(out.state[147 * joints.size() + hand] == Tracking::tracked);
  CHECK(out.state[153 * joints.size() + hand] == Tracking::tracked);
}

TEST_CASE("inferred joints stay marked between and at their samples") {
  auto kinect = points(joints, every(30 * ms, 100), wander);
  kinect.frames.state[50 * joints.size() + 1] = Tracking::inferred;
  const auto take = align(two(points(joints, every(10 * ms, 298), wander), kinect), {});
  REQUIRE(take);
  for (std::size_t r = 148; r <= 152; ++r) {
    CHECK(rows(*take, 1).state[r * joints.size() + 1] == Tracking::inferred);
    CHECK(rows(*take, 1).valid[r * joints.size() + 1] == 1);
  }
  CHECK(take->report.streams[1].inferred == 5);
}

TEST_CASE("stamps that repeat or step back are left out and reported") {
  auto stamps = every(30 * ms, 100);
  stamps[20] = stamps[19];
  stamps[60] = stamps[57];
  const auto take =
      align(two(points(joints, every(10 * ms, 298), wander), points(joints, stamps, wander)),
            own_space());
  REQUIRE(take);
  CHECK(take->report.streams[1].survey.duplicates == 1);
  CHECK(take->report.streams[1].survey.backward == 1);
  REQUIRE(take->report.findings.size() == 2);
  CHECK(to_string(take->report.findings[0].what) ==
        "kinect: expected rising stamps, found 1 of 100 that step back, by up to 0.060 s");
}

TEST_CASE("streams that do not overlap are refused with their spans") {
  const auto take = align(two(points(joints, every(10 * ms, 100), wander),
                              points(joints, every(30 * ms, 100, 5'000 * ms), wander)),
                          {});
  REQUIRE(!take);
  CHECK(to_string(take.error()) ==
        "expected streams that overlap in time (see start_ns and offset_ms), found "
        "optical 0.000 to 0.990 s, kinect 5.000 to 7.970 s");
}

TEST_CASE("samples in bursts are a warning, and rate_hz tells the true period") {
  std::vector<Time> stamps;  // three at once every 99 ms, as some radios deliver them
  for (std::int64_t k = 0; k < 100; ++k) {
    stamps.push_back(utc_time((k / 3) * 99 * ms + (k % 3) * ms));
  }
  const Recording recording =
      two(points(joints, every(10 * ms, 320), wander), points(joints, stamps, wander));
  const auto take = align(recording, {});
  REQUIRE(take);
  CHECK(take->report.streams[1].invalid > take->report.streams[1].samples / 2);
  REQUIRE(!take->report.findings.empty());
  CHECK(
      to_string(take->report.findings[0].what) ==
      "kinect: expected steps near their median of 1 ms, found 33 longer steps, 98 % of the time");
  Manifest manifest;
  manifest.streams.resize(1);
  manifest.streams[0].name = "kinect";
  manifest.streams[0].rate_hz = 30.0;
  const auto told = align(recording, manifest);
  REQUIRE(told);
  // Only the last sample of each burst counts. The take's first row lies before the first of these,
  // so all its joints are invalid.
  CHECK(told->report.streams[1].invalid == joints.size());
  CHECK(told->report.streams[1].held_back == 66);
}

TEST_CASE("a stream without samples is refused with what its reader found wrong, if it did") {
  Recording recording =
      two(points(joints, every(10 * ms, 100), wander), points(joints, every(30 * ms, 0), wander));
  const auto refusal = [&recording] {
    const auto take = align(recording, {});
    return take ? "" : to_string(take.error());
  };
  CHECK(refusal() == "expected at least one sample for stream 'kinect', found none");
  recording.streams[1].files = {{"kinect.csv", "", 0}};
  CHECK(refusal() == "kinect.csv: expected at least one sample for stream 'kinect', found none");
  recording.streams[1].findings = {
      {Severity::error, Error{"k.csv", 0, "rows of body 3", "none"}, "the stream is empty", ""},
      {Severity::note, Error{"k.csv", 0, "less", "more"}, "", ""}};
  CHECK(refusal() == "k.csv: expected rows of body 3, found none");
  recording.streams[1].findings.clear();
  recording.streams[1].shared_file = 0;
  recording.shared_files = {
      {{{Severity::error, Error{"k.mcap", 0, "a record", "none"}, "nothing was read", ""}}, {}}};
  CHECK(refusal() == "k.mcap: expected a record, found none");
}

TEST_CASE("the marks of a file that two streams are read from stand once in the report") {
  Recording recording =
      two(points(joints, every(10 * ms, 100), wander), points(joints, every(30 * ms, 33), wander));
  const TakeMark start{Time{Duration{5 * ms}}, "start", "dance", std::nullopt, "keyboard"};
  for (RecordedStream& stream : recording.streams) {
    stream.files = {{"take.mcap", "", 0}};
    stream.shared_file = 0;
  }
  recording.shared_files = {{{}, {start}}};
  const auto take = align(recording, {});
  REQUIRE(take);
  CHECK(take->report.marks == std::vector<TakeMark>{start});
}
