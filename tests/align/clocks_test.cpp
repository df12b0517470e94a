// SPDX-License-Identifier: Apache-2.0
// From a device's stamps to the take's time axis, and the doubt that a take states for it.
#include "tests/align/two_streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// A Kinect whose clock is `clock`: its samples are taken at times of the take's axis, but its
/// stamps are those of its own clock.
Take seen_through(const TimeModelPiece& clock) {
  Recording recording = two(points(joints, every(10 * ms, 600, 1000 * ms), wander), {});
  const auto on_axis = [&](Time stamp) { return take_time({{clock}}, stamp); };
  auto stamps = every(30 * ms, 300);
  PointStream kinect = points(joints, stamps, [&](std::size_t j, double t) {
    const Time stamp = utc_time(std::llround(t * 1e9));
    return wander(j, 1e-9 * static_cast<double>(to_ns(on_axis(stamp))));
  });
  recording.streams[1] = recorded("kinect", std::move(kinect));
  recording.streams[1].clock = {{clock}};
  const auto take = align(recording, own_space());
  REQUIRE_MESSAGE(take, (take ? "" : to_string(take.error())));
  return *take;
}

}  // namespace

TEST_CASE("an offset and a drift bring every sample to its time on the take's axis") {
  for (const std::uint64_t seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    TimeModelPiece clock;
    clock.begin = utc_time(0);
    clock.offset = Duration{static_cast<std::int64_t>(random() % 1000) * ms};
    clock.drift_ppm = static_cast<double>(random() % 2000) - 1000.0;
    const Take take = seen_through(clock);
    for (std::size_t r = 50; r + 50 < take.all.stamps.size(); ++r) {
      const double t = 1e-9 * static_cast<double>(to_ns(take.all.stamps[r]));
      CHECK((at(rows(take, 1), r, 2) - wander(2, t)).norm() < 2e-6);
    }
  }
}

TEST_CASE("a take's span is the one of the corrected stamps") {
  TimeModelPiece clock;
  clock.begin = utc_time(0);
  clock.offset = Duration{2000 * ms};
  const Take take = seen_through(clock);
  CHECK(to_ns(take.all.stamps.front()) == 2000 * ms);
  CHECK(to_ns(take.all.stamps.back()) == 6990 * ms);  // the reference's end
}

TEST_CASE("each stamp has its uncertainty; it is zero only with a shared clock") {
  TimeModelPiece clock;
  const Take unknown = seen_through(clock);
  CHECK_FALSE(unknown.header.groups[1].interval_known);
  CHECK(rows(unknown, 1).distance.time_interval_ns.empty());
  CHECK_FALSE(unknown.report.streams[1].worst_interval_ns);

  const Take shared = seen_through(shared_clock().pieces.front());
  CHECK(shared.header.groups[1].interval_known);
  const auto& none = rows(shared, 1).distance.time_interval_ns;
  CHECK(none == std::vector<std::int64_t>(shared.all.stamps.size(), 0));
  CHECK(shared.report.streams[1].worst_interval_ns == 0);

  clock.half_width = Duration{3'500'000};
  const Take known = seen_through(clock);
  const auto& widths = rows(known, 1).distance.time_interval_ns;
  CHECK(widths == std::vector<std::int64_t>(known.all.stamps.size(), 3'500'000));
  CHECK(known.report.streams[1].worst_interval_ns == 3'500'000);
}

TEST_CASE(
    "the reference is its own samples: no distance, no doubt; what of its points was lost counts") {
  PointStream optical = points(joints, every(10 * ms, 100), wander);
  optical.frames.state[5] = Tracking::missing;
  Recording recording = two(optical, points(joints, every(30 * ms, 34), wander));
  for (RecordedStream& stream : recording.streams) stream.clock = shared_clock();
  const auto take = align(recording, own_space());
  REQUIRE(take);
  CHECK_FALSE(take->header.groups[0].resampled);
  CHECK_FALSE(take->header.groups[0].interval_known);
  CHECK(rows(*take, 0).distance.nearest_raw_ns.empty());
  CHECK(rows(*take, 0).distance.time_interval_ns.empty());
  CHECK(rows(*take, 0).valid[5] == 0);
  CHECK(take->report.streams[0].samples == 400);
  CHECK(take->report.streams[0].invalid == 1);
  CHECK(take->header.groups[1].resampled);
  CHECK(take->header.groups[1].interval_known);
}

TEST_CASE("samples without an interval are distinguished from samples with an interval") {
  Recording recording =
      two(points(joints, every(10 * ms, 400), wander), points(joints, every(30 * ms, 134), wander));
  TimeModelPiece certified, doubtful;
  certified.half_width = Duration{1 * ms};
  doubtful.begin = utc_time(1500 * ms);
  recording.streams[1].clock.pieces = {certified, doubtful};
  const auto take = align(recording, own_space());
  REQUIRE(take);
  const auto& widths = rows(*take, 1).distance.time_interval_ns;
  REQUIRE(widths.size() == take->all.stamps.size());
  std::uint64_t unsure = 0;
  for (std::size_t r = 0; r < widths.size(); ++r) {
    const bool known = to_ns(take->all.stamps[r]) < 1500 * ms;
    CHECK(widths[r] == (known ? 1 * ms : no_interval));
    unsure += known ? 0 : 1;
  }
  CHECK(take->report.streams[1].worst_interval_ns == 1 * ms);
  CHECK(take->report.streams[1].unsure == unsure * joints.size());
}

TEST_CASE("pieces of a clock serve the stamps from their beginning on") {
  Recording recording =
      two(points(joints, every(10 * ms, 400), wander), points(joints, every(30 * ms, 134), wander));
  TimeModelPiece first, second;
  first.half_width = Duration{1 * ms};
  second.begin = utc_time(1500 * ms);
  second.half_width = Duration{4 * ms};
  recording.streams[1].clock.pieces = {first, second};
  const auto take = align(recording, own_space());
  REQUIRE(take);
  const auto& widths = rows(*take, 1).distance.time_interval_ns;
  REQUIRE(widths.size() == take->all.stamps.size());
  for (std::size_t r = 0; r < widths.size(); ++r) {
    const std::int64_t row = to_ns(take->all.stamps[r]);
    CHECK(widths[r] == (row < 1500 * ms ? 1 * ms : 4 * ms));
  }
  CHECK(take->report.streams[1].worst_interval_ns == 4 * ms);
}

TEST_CASE("the header promises as many rows as come, wherever the span cuts, whatever repeats") {
  for (const std::uint64_t seed : fresh_seeds(60)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::vector<Time> stamps;
    std::int64_t t = 0;
    for (int i = 0; i < 300; ++i) {
      stamps.push_back(utc_time(t));
      const std::uint64_t kind = random() % 20;
      t += kind == 0 ? 0 : kind == 1 ? -5 * ms : static_cast<std::int64_t>(1 + random() % 20) * ms;
    }
    const auto start = static_cast<std::int64_t>(random() % 1000) * ms;
    const auto count = static_cast<std::size_t>(2 + random() % 40);
    const PointStream reference = points(joints, stamps, wander);
    const auto blocks = read_in_blocks(recorded("optical", reference), reference.frames, 37);
    Recording recording;
    recording.streams = {blocks,
                         recorded("kinect", points(joints, every(33 * ms, count, start), wander))};
    const auto take = align(recording, own_space());
    if (!take) {  // no row in the span
      CHECK(take.error().expected == "frames of 'optical' in the common span");
      continue;
    }
    CHECK(take->header.frames == take->all.stamps.size());
    CHECK(take->report.frames == take->all.stamps.size());
    CHECK(take->report.begin == take->all.stamps.front());
    CHECK(take->report.end == take->all.stamps.back());
    const auto& rows = take->all.stamps;
    CHECK(std::is_sorted(rows.begin(), rows.end(), std::less_equal<>()));
    CHECK(to_ns(rows.front()) >= start);
    CHECK(to_ns(rows.back()) <= start + 33 * ms * static_cast<std::int64_t>(count - 1));
    for (const Time row : rows) CHECK(std::find(stamps.begin(), stamps.end(), row) != stamps.end());
  }
}

TEST_CASE("rows of a stream with a fixed step are counted exactly") {
  for (const double step_ns : {8.3333e6, 16'666'667.0, 1e9 / 59.94}) {
    for (std::size_t count = 1; count < 40; ++count) {
      CAPTURE(step_ns);
      CAPTURE(count);
      std::vector<Time> stamps;
      for (int k = 0; k < 60; ++k) stamps.push_back(utc_time(std::llround(k * step_ns)));
      auto reference = recorded("optical", points(joints, stamps, wander));
      reference.step_ns = step_ns;
      Recording recording;  // from one of the reference's stamps to another
      recording.streams = {
          reference, recorded("kinect", points(joints, {stamps[10], stamps[10 + count]}, wander))};
      const auto take = align(recording, own_space());
      REQUIRE(take);
      CHECK(take->header.frames == count + 1);
      CHECK(take->all.stamps.size() == count + 1);
    }
  }
}
