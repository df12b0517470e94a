// SPDX-License-Identifier: Apache-2.0
// Samples that were delayed on their way and stamped on arrival, just before the next sample.
// Wherever they stand, no curve may run through them.
#include "tests/align/two_streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"
#include "kinalign/resample/window.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

using namespace kinalign;
using namespace kinalign::test;

namespace {

constexpr std::int64_t step = 33 * ms;

/// A hand at 3 m/s on a straight line, on which any spline through true samples lies.
Vec3 hand(std::size_t, double t) { return {3.0 * t, 1.0, -3.0 * t}; }

/// The same samples with later stamps.
PointStream stamped(const std::vector<Time>& taken, const std::vector<Time>& arrived) {
  PointStream out = points(joints, taken, hand);
  out.frames.stamps = arrived;
  return out;
}

/// Largest distance of a valid row from the truth, m.
double worst_of(const Take& take) {
  const PointRows& kinect = rows(take, 1);
  double worst = 0.0;
  for (std::size_t r = 0; r < take.all.stamps.size(); ++r) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (kinect.valid[r * joints.size() + j] == 0) continue;
      const double t = 1e-9 * static_cast<double>(to_ns(take.all.stamps[r]));
      worst = std::max(worst, (at(kinect, r, j) - hand(j, t)).norm());
    }
  }
  return worst;
}

Take aligned(PointStream kinect, double rate_hz = 0.0) {
  Manifest manifest = own_space();
  manifest.streams.resize(1);
  manifest.streams[0].name = "kinect";
  manifest.streams[0].rate_hz = rate_hz;
  // The grid goes on to the Kinect's end, so no sample after the take is counted.
  const auto rows =
      static_cast<std::size_t>(to_ns(kinect.frames.stamps.back()) / (10 * ms)) + std::size_t{2};
  auto take = align(two(points(joints, every(10 * ms, rows), wander), std::move(kinect)), manifest);
  REQUIRE(take);
  return *std::move(take);
}

}  // namespace

TEST_CASE("samples just before the next sample are dropped, wherever they are") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<Time> taken{utc_time(0)};
    while (taken.size() < 120) {
      taken.push_back(taken.back() + Duration{step + static_cast<std::int64_t>(random() % 6) * ms});
    }
    std::vector<Time> arrived = taken;
    const std::size_t opening = random() % 11;  // wait in a buffer until the next one comes
    std::uint64_t late = opening;
    for (std::size_t i = opening; i-- > 0;) arrived[i] = arrived[i + 1] - Duration{200'000};
    for (std::size_t i = opening + 1; i + 1 < taken.size(); ++i) {
      if (random() % 10 != 0) continue;
      const std::size_t stall = std::min(1 + random() % 4, taken.size() - 1 - i);
      for (std::size_t k = stall; k-- > 0;) arrived[i + k] = arrived[i + k + 1] - Duration{ms};
      late += stall;
      i += stall;
    }
    const Take take = aligned(stamped(taken, arrived));
    CHECK(worst_of(take) <= 1e-9);
    CHECK(take.report.streams[1].held_back == late);
    REQUIRE(!take.report.findings.empty() == (late > 0));
    if (late > 0) CHECK(take.report.findings[0].severity == Severity::warning);
  }
}

TEST_CASE(
    "a fifth of the usual step is not near yet, and the usual step is the stated one, if any") {
  const auto held_back = [](std::int64_t nearest, double rate_hz) {
    std::vector<Time> stamps = every(50 * ms, 40);
    stamps[20] = stamps[21] - Duration{nearest};
    return aligned(stamped(stamps, stamps), rate_hz).report.streams[1].held_back;
  };
  CHECK(held_back(10 * ms, 0.0) == 0);
  CHECK(held_back(10 * ms - 1, 0.0) == 1);
  CHECK(held_back(10 * ms - 1, 40.0) == 0);
  CHECK(held_back(5 * ms - 1, 40.0) == 1);
}

TEST_CASE("rows in which nothing was seen hold no sample back") {
  PointStream kinect = points(joints, every(step, 60), hand);
  PointStream beats;  // an empty row a millisecond before and after each fifth sample
  beats.joint_names = joints;
  for (std::size_t i = 0; i < 60; ++i) {
    const auto empty = [&](Time stamp) {
      beats.frames.stamps.push_back(stamp);
      beats.frames.positions.insert(beats.frames.positions.end(), 3 * joints.size(), 0.0);
      beats.frames.state.insert(beats.frames.state.end(), joints.size(), Tracking::missing);
    };
    if (i % 5 == 1) empty(kinect.frames.stamps[i] - Duration{ms});
    append_rows(beats.frames, kinect.frames, i, 1);
    if (i % 5 == 1) empty(kinect.frames.stamps[i] + Duration{ms});
  }
  const Take take = aligned(beats);
  CHECK(take.report.streams[1].held_back == 0);
  CHECK(take.report.streams[1].invalid == 0);
  CHECK(worst_of(take) <= 1e-9);
}

TEST_CASE("a stretch at a much higher rate loses eight samples at its begin") {
  std::vector<Time> stamps = every(1000 * ms, 60);
  for (std::int64_t k = 1; k <= 500; ++k) stamps.push_back(stamps.back() + Duration{10 * ms});
  for (std::int64_t k = 1; k <= 700; ++k) stamps.push_back(stamps.back() + Duration{1000 * ms});
  const Take take = aligned(stamped(stamps, stamps));
  CHECK(take.report.streams[1].held_back == 8);
  CHECK(take.report.streams[1].invalid == 0);
  CHECK(worst_of(take) <= 1e-7);
}

TEST_CASE("a loop that reads slower than the device measures loses the first of each pair only") {
  std::vector<Time> taken, read;
  std::uint64_t pairs = 0;
  for (std::int64_t turn = 0, k = 0; turn < 300; ++turn) {
    for (int found = 0; k * step <= turn * 35 * ms; ++k, ++found) {
      taken.push_back(utc_time(k * step));
      read.push_back(utc_time(turn * 35 * ms + found * ms / 10));
      pairs += found > 0 ? 1 : 0;
    }
  }
  const Take take = aligned(stamped(taken, read));
  CHECK(take.report.streams[1].held_back == pairs);
  CHECK(worst_of(take) < 0.2);  // late by a step at the most: 4.2 m/s in 35 ms
}

TEST_CASE(
    "of reads that find three samples the first two are left out, with a stated rate or without") {
  for (const double rate_hz : {0.0, 30.3}) {
    std::vector<Time> taken, read;
    std::uint64_t held_back = 0;
    for (std::int64_t turn = 0, k = 0, at = 0; turn < 400; ++turn) {
      at += turn == 200 ? 70 * ms : 50 * ms;
      int found = 0;
      for (; k * step <= at; ++k, ++found) {
        taken.push_back(utc_time(k * step));
        read.push_back(utc_time(at + found * ms / 10));
      }
      held_back += found > 1 ? static_cast<std::uint64_t>(found - 1) : 0;
    }
    const Take take = aligned(stamped(taken, read), rate_hz);
    CHECK(take.report.streams[1].held_back == held_back);
    CHECK(worst_of(take) < 0.3);  // late by less than two steps: 4.2 m/s in 66 ms
  }
}

TEST_CASE("nodes in rows of their own hold none of each other's back") {
  for (const std::int64_t behind_us : {100, 1500}) {
    CAPTURE(behind_us);
    PointStream both;  // joints by two trackers, each in its own rows
    both.joint_names = joints;
    for (std::int64_t i = 0; i < 200; ++i) {
      for (const std::size_t j : {std::size_t{0}, std::size_t{1}}) {
        const std::int64_t t = i * step + (j == 0 ? 0 : behind_us * 1000);
        both.frames.stamps.push_back(utc_time(t));
        for (std::size_t cell = 0; cell < joints.size(); ++cell) {
          const Vec3 at = cell % 2 == j ? hand(cell, 1e-9 * static_cast<double>(t)) : Vec3::Zero();
          both.frames.positions.insert(both.frames.positions.end(), at.begin(), at.end());
          both.frames.state.push_back(cell % 2 == j ? Tracking::tracked : Tracking::missing);
        }
      }
    }
    const Take take = aligned(both, 1e9 / step);
    CHECK(take.report.streams[1].held_back == 0);
    CHECK(take.report.streams[1].invalid * 100 < 2 * take.report.streams[1].samples);
    CHECK(worst_of(take) <= 1e-9);
  }
}

TEST_CASE("late samples are dropped for each node separately, in any order of nodes") {
  for (const std::size_t polled : {0, 1}) {
    for (const std::size_t begins : {0, 1}) {
      CAPTURE(polled);
      CAPTURE(begins);
      struct Row {
        std::int64_t arrived, taken;
        std::size_t node;
      };
      std::vector<Row> all;  // one node that is read in a loop each 50 ms
      for (std::int64_t i = 0; i < 200; ++i) {
        const std::int64_t read = (i * step + 50 * ms - 1) / (50 * ms) * 50 * ms;
        const bool second = i > 0 && ((i - 1) * step + 50 * ms - 1) / (50 * ms) * 50 * ms == read;
        all.push_back({read + (second ? ms / 10 : 0), i * step, polled});
        // Between two readings.
        if (!second) all.push_back({read + ms / 20, read + ms / 20, 1 - polled});
      }
      std::sort(all.begin(), all.end(),
                [](const Row& a, const Row& b) { return a.arrived < b.arrived; });
      while (all.front().node != begins) all.erase(all.begin());
      PointStream both;
      both.joint_names = joints;
      for (const Row& row : all) {
        both.frames.stamps.push_back(utc_time(row.arrived));
        for (std::size_t cell = 0; cell < joints.size(); ++cell) {
          const bool own = cell % 2 == row.node;
          const Vec3 at = own ? hand(cell, 1e-9 * static_cast<double>(row.taken)) : Vec3::Zero();
          both.frames.positions.insert(both.frames.positions.end(), at.begin(), at.end());
          both.frames.state.push_back(own ? Tracking::tracked : Tracking::missing);
        }
      }
      const Take take = aligned(both, 1e9 / step);
      CHECK(take.report.streams[1].held_back > 60);
      CHECK(worst_of(take) < 0.3);  // 50 ms at 3 m/s in two axes, and a curve; with them 9.6 m
    }
  }
}

TEST_CASE("if half of a row was delayed, only this half is dropped") {
  PointStream half = points(joints, every(step, 200), hand);
  PointFrames& rows = half.frames;  // 0.1 ms after each row another row with one hand as it is then
  PointStream out;
  out.joint_names = joints;
  for (std::size_t i = 0; i < 200; ++i) {
    for (const bool again : {false, true}) {
      const std::int64_t t = to_ns(rows.stamps[i]) + (again ? ms / 10 : 0);
      out.frames.stamps.push_back(utc_time(t));
      for (std::size_t cell = 0; cell < joints.size(); ++cell) {
        const bool there = !again || cell == 3;
        const Vec3 at = there ? hand(cell, 1e-9 * static_cast<double>(t)) : Vec3::Zero();
        out.frames.positions.insert(out.frames.positions.end(), at.begin(), at.end());
        out.frames.state.push_back(there ? Tracking::tracked : Tracking::missing);
      }
    }
  }
  const Take take = aligned(out, 1e9 / step);
  CHECK(take.report.streams[1].held_back == 200);
  CHECK(take.report.streams[1].invalid * 100 < take.report.streams[1].samples);
  CHECK(worst_of(take) <= 1e-9);
}

TEST_CASE("the reference keeps its rows, and blocks of any size hold back the same samples") {
  std::vector<Time> stamps = every(step, 100);
  for (const std::size_t late : {0, 2, 50, 98}) stamps[late] = stamps[late + 1] - Duration{ms};
  const PointStream all = stamped(every(step, 100), stamps);
  const auto take = align(two(all, points(joints, every(10 * ms, 400), wander)), own_space());
  REQUIRE(take);
  CHECK(take->report.frames == 100);
  CHECK(take->report.streams[0].held_back == 0);
  // They are used, but a finding says that the stamps are not the device's.
  REQUIRE(take->report.findings.size() == 1);
  CHECK(take->report.findings[0].what.found.starts_with("4 closer to the next sample"));
  CHECK(take->report.findings[0].meaning.find("is the reference") != std::string::npos);
  for (const std::size_t size : {1, 2, 7, 100}) {
    CAPTURE(size);
    Recording recording = two(points(joints, every(10 * ms, 400), wander), all);
    recording.streams[1] = read_in_blocks(recording.streams[1], all.frames, size);
    const auto in_pieces = align(recording, own_space());
    REQUIRE(in_pieces);
    CHECK(in_pieces->report.streams[1].held_back == 4);
    CHECK(worst_of(*in_pieces) <= 1e-9);
  }
}

TEST_CASE("a wild stamp between a late sample and the next one hides nothing") {
  for (const std::size_t late : {0, 1, 2, 3, 50}) {
    CAPTURE(late);
    std::vector<Time> taken = every(step, 100), arrived = taken;
    arrived[late] = arrived[late + 1] - Duration{ms / 10};
    const auto behind = static_cast<std::ptrdiff_t>(late + 1);
    taken.insert(taken.begin() + behind, taken[late]);
    arrived.insert(arrived.begin() + behind, arrived[late] + Duration{3'600'000 * ms});
    const Take take = aligned(stamped(taken, arrived));
    CHECK(take.report.streams[1].survey.ahead == 1);
    CHECK(take.report.streams[1].held_back == 1);
    CHECK(worst_of(take) <= 1e-9);
  }
}

TEST_CASE("samples sent in a burst after a stall are a warning") {
  std::vector<Time> arrived = every(step, 200);
  for (std::size_t k = 100; k < 200; ++k) {  // a second without samples, and then 10 ms each
    const Time sent = k == 100 ? arrived[130] : arrived[k - 1] + Duration{10 * ms};
    arrived[k] = std::max(arrived[k], sent);
  }
  const Take take = aligned(stamped(every(step, 200), arrived));
  CHECK(take.report.streams[1].arrivals.late >= 30);
  CHECK(take.report.streams[1].arrivals.worst_late_ns > 900 * ms);
  REQUIRE(take.report.findings.size() == 1);
  CHECK(take.report.findings[0].severity == Severity::warning);
  CHECK(take.report.findings[0].what.expected == "samples without delay");
}

TEST_CASE("a stated rate that is a tenth off makes no sample late, nor a stamp that is rounded") {
  std::vector<Time> stamps = every(step, 200);
  for (std::size_t k = 100; k < 200; ++k) stamps[k] += Duration{500 * ms};  // a true pause
  CHECK(aligned(stamped(stamps, stamps), 28.0).report.streams[1].arrivals.late == 0);
  CHECK(aligned(stamped(stamps, stamps), 25.0).report.streams[1].arrivals.late == 0);
  for (Time& t : stamps) t = utc_time(to_ns(t) / (10 * ms) * (10 * ms));
  CHECK(aligned(stamped(stamps, stamps)).report.streams[1].arrivals.late == 0);
}

TEST_CASE("one sample per step stays of a delayed stretch") {
  std::vector<Time> arrived = every(step, 60);
  for (std::int64_t k = 0; k < 150; ++k) {  // five seconds' silence, and then all within 4.5 steps
    arrived.push_back(arrived[59] + Duration{5000 * ms + k * ms});
  }
  for (std::int64_t k = 1; k < 60; ++k) arrived.push_back(arrived[209] + Duration{k * step});
  std::vector<Time> taken = arrived;  // only the count is checked
  const std::uint64_t left =
      150 - aligned(stamped(taken, arrived), 1e9 / step).report.streams[1].held_back;
  CHECK(left >= 4);
  CHECK(left <= 6);
}
