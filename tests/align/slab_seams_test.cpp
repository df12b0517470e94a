// SPDX-License-Identifier: Apache-2.0
// A take is made in slabs from windows of its streams, and neither may change a value. The truth
// here is one spline through all samples at once.
#include "tests/align/same_take.h"
#include "tests/align/streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"
#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/resample/resample.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;
using namespace kinalign::test;

namespace {

constexpr std::size_t block_rows = 40;  // the size of the blocks in which a reader hands out a file

/// 5000 rows of a grid are three slabs.
RecordedStream grid() {
  return recorded("points", points({"a"}, every(10 * ms, 5000, 1000 * ms), wander));
}

/// Irregular stamps over the grid and a little more.
std::vector<Time> irregular(std::int64_t step_ns) {
  std::mt19937_64 random(7);
  std::vector<Time> out;
  for (std::int64_t t = 0; t < 52'000 * ms;) {
    out.push_back(utc_time(t));
    t += step_ns / 2 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(step_ns));
  }
  return out;
}

std::vector<double> seconds(const std::vector<Time>& stamps) {
  std::vector<double> out;
  for (const Time t : stamps) out.push_back(1e-9 * static_cast<double>(to_ns(t)));
  return out;
}

/// The natural spline through all of (stamps, values [T,3]) at the rows of a take.
std::vector<double> at_once(const std::vector<Time>& stamps, const std::vector<double>& values,
                            const Take& take) {
  const auto times = seconds(stamps), rows = seconds(take.all.stamps);
  const Knots knots{times, values, 3};
  std::vector<double> bends(values.size()), out(3 * rows.size());
  natural_spline(knots, bends);
  spline_at(knots, bends, rows, out);
  return out;
}

/// Largest difference of column `column` of an array [n,columns,width] from [n,width].
double farthest(const std::vector<double>& array, std::size_t columns, std::size_t column,
                const std::vector<double>& truth, std::size_t width = 3) {
  double most = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::size_t row = i / width, k = i % width;
    most = std::max(most, std::abs(array[(row * columns + column) * width + k] - truth[i]));
  }
  return most;
}

}  // namespace

TEST_CASE("points of many slabs are one spline's, also of a joint that was seldom seen") {
  const auto stamps = irregular(20 * ms);
  PointStream kinect = points({"a", "seldom"}, stamps, wander);
  std::vector<Time> seen;
  std::vector<double> all, some;
  for (std::size_t t = 0; t < stamps.size(); ++t) {
    const auto cell = [&](std::size_t j) { return vec3(kinect.frames.positions, 2 * t + j); };
    all.insert(all.end(), cell(0).begin(), cell(0).end());
    if (t % 50 != 0 && t + 1 != stamps.size()) {
      kinect.frames.state[2 * t + 1] = Tracking::missing;
      continue;
    }
    seen.push_back(stamps[t]);
    some.insert(some.end(), cell(1).begin(), cell(1).end());
  }
  const RecordedStream other =
      read_in_blocks(recorded("kinect", kinect), kinect.frames, block_rows);
  Recording recording;
  recording.streams = {grid(), other};
  Manifest manifest;
  manifest.align.gap_ms = 3000.0;
  const auto take = align(recording, manifest);
  REQUIRE(take);
  REQUIRE(take->all.stamps.size() == 5000);
  const auto& rows = std::get<PointRows>(take->all.rows[1]);
  CHECK(farthest(rows.positions, 2, 0, at_once(stamps, all, *take)) < 1e-12);
  CHECK(farthest(rows.positions, 2, 1, at_once(seen, some, *take)) < 1e-12);
  CHECK(take->report.streams[1].invalid == 0);
}

TEST_CASE("a clip of many slabs is one curve's: places to 1e-12 m, turns to 1e-9 rad") {
  const auto stamps = irregular(20 * ms);
  Clip clip;
  clip.skeleton = {{"Hips"}, {-1}, {Vec3::Zero()}, {}};
  clip.frames.stamps = stamps;
  for (const double t : seconds(stamps)) {
    const Vec3 p = wander(0, t);
    clip.frames.local_positions.insert(clip.frames.local_positions.end(), p.begin(), p.end());
    const Quat q = Quat(Eigen::AngleAxisd(2.0 * std::sin(t), Vec3::UnitX()) *
                        Eigen::AngleAxisd(std::sin(1.7 * t), Vec3::UnitY()));
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
      clip.frames.local_rotations.push_back(part);
    }
  }
  const RecordedStream other = read_in_blocks(recorded("mocap", clip), clip.frames, block_rows);
  Recording recording;
  recording.streams = {grid(), other};
  const auto take = align(recording, {});
  REQUIRE(take);
  const auto& rows = std::get<ClipRows>(take->all.rows[1]);
  CHECK(farthest(rows.local_positions, 1, 0, at_once(stamps, clip.frames.local_positions, *take)) <
        1e-12);
  const auto times = seconds(stamps), at = seconds(take->all.stamps);
  const RotationKnots knots{times, clip.frames.local_rotations};
  std::vector<double> turned(4 * at.size());
  rotation_spline_at(knots, at, turned);
  CHECK(farthest(rows.local_rotations, 1, 0, turned, 4) < 1e-9);
}

TEST_CASE("nodes of many slabs are one spline's across every loss shorter than the gap") {
  const auto stamps = every(1 * ms, 52'000);
  ImuStream node = nodes({"waist"}, stamps, [](std::size_t, double t) {
    return Quat(Eigen::AngleAxisd(std::sin(t), Vec3::UnitX()));
  });
  std::vector<Time> seen;
  std::vector<double> values;
  for (std::size_t t = 0; t < stamps.size(); ++t) {
    if (t % 400 >= 150) {  // 250 ms of each 400
      node.samples.valid[t] = 0;
      continue;
    }
    seen.push_back(stamps[t]);
    const auto a = vec3(node.samples.acceleration, t);
    values.insert(values.end(), a.begin(), a.end());
  }
  const RecordedStream other = read_in_blocks(recorded("imu", node), node.samples, block_rows);
  Recording recording;
  recording.streams = {grid(), other};
  Manifest manifest;
  manifest.align.gap_ms = 300.0;
  const auto take = align(recording, manifest);
  REQUIRE(take);
  CHECK(take->report.streams[1].invalid == 0);
  const auto& rows = std::get<ImuRows>(take->all.rows[1]);
  // The largest value is 9.8.
  CHECK(farthest(rows.acceleration, 1, 0, at_once(seen, values, *take)) < 1e-11);
}

TEST_CASE("an empty sample of a node is none: it shortens no distance and hides no loss") {
  const auto stamps = every(30 * ms, 200);
  ImuStream node = nodes({"waist"}, stamps, [](std::size_t, double) { return Quat::Identity(); });
  for (const std::size_t t : {60U, 61U}) node.samples.valid[t] = 0;   // bridged
  for (std::size_t t = 100; t < 120; ++t) node.samples.valid[t] = 0;  // a gap
  Recording recording;
  recording.streams = {recorded("points", points({"a"}, every(10 * ms, 590), wander)),
                       recorded("imu", node)};
  const auto take = align(recording, {});
  REQUIRE(take);
  const auto& rows = std::get<ImuRows>(take->all.rows[1]);
  CHECK(rows.distance.nearest_raw_ns[181] == 40 * ms);  // 1810 ms: the last sample was at 1770
  CHECK(rows.valid[181] == 1);
  CHECK(rows.distance.nearest_raw_ns[330] == 300 * ms);  // 3300 ms: 2970 and 3600
  CHECK(rows.valid[330] == 0);
  const StreamReport& report = take->report.streams[1];
  CHECK(report.gaps == 1);
  CHECK(report.gap_time_ns == 630 * ms);
  CHECK(report.bridged == 8);
  CHECK(report.worst_nearest_ns == 40 * ms);
}

TEST_CASE("distances to raw samples are stored up to ten seconds") {
  auto stamps = every(30 * ms, 100);
  for (const Time t : every(30 * ms, 100, 60'000 * ms)) stamps.push_back(t);
  PointStream kinect = points({"a"}, stamps, wander);
  const RecordedStream other =
      read_in_blocks(recorded("kinect", kinect), kinect.frames, block_rows);
  Recording recording;
  recording.streams = {recorded("points", points({"a"}, every(10 * ms, 6290), wander)), other};
  const auto take = align(recording, {});
  REQUIRE(take);
  const auto& nearest = std::get<PointRows>(take->all.rows[1]).distance.nearest_raw_ns;
  CHECK(nearest[297] == 0);
  CHECK(nearest[1000] == 10'000 * ms - 2970 * ms);
  CHECK(nearest[3000] == 10'000 * ms);
  CHECK(nearest[5500] == 5'000 * ms);
}

namespace {

/// A Kinect of 150 s with samples that were held back, a pause of 15 s, and a clock that begins
/// anew up to 4 s too early.
RecordedStream troubled_kinect(std::mt19937_64& random, PointStream& kinect) {
  std::vector<Time> stamps;
  for (std::int64_t t = 0; t < 150'000 * ms; t += 33 * ms) {
    if (t > 40'000 * ms && t < 55'000 * ms) continue;
    const bool held_back = random() % 20 == 0;
    stamps.push_back(utc_time(t + (held_back ? 32 * ms : 0)));
  }
  kinect = points({"a"}, stamps, wander);
  RecordedStream out = recorded("kinect", kinect);
  TimeModelPiece first, second;
  first.half_width = Duration{ms};
  second.begin = utc_time(static_cast<std::int64_t>(60'000 + random() % 60'000) * ms);
  second.offset = Duration{-static_cast<std::int64_t>(random() % 4'000) * ms};
  out.clock.pieces = {first, second};
  return out;
}

}  // namespace

TEST_CASE("how a stream is cut into blocks shows in no row and no count") {
  for (const auto seed : fresh_seeds(10)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    PointStream kinect;
    const RecordedStream other = troubled_kinect(random, kinect);
    // The grid ends in a pause, so the take goes on after its last row but one.
    std::vector<Time> rows = every(10 * ms, 12'000);
    rows.push_back(utc_time(130'000 * ms));
    const RecordedStream points_a = recorded("points", points({"a"}, rows, wander));
    const auto aligned = [&](std::size_t size) {
      Recording recording;
      recording.streams = {points_a, read_in_blocks(other, kinect.frames, size)};
      auto take = align(recording, own_space());
      REQUIRE(take);
      return *std::move(take);
    };
    const Take whole = aligned(kinect.frames.size());
    CHECK(whole.report.streams[1].held_back > 0);
    for (const std::size_t size : {1U, 7U, 500U}) check_same(aligned(size), whole);
  }
}

TEST_CASE("a reference with a drift and rows out of order has the rows that were counted") {
  for (double drift = 0.5; drift < 60.0; drift += 1.37) {
    CAPTURE(drift);
    std::vector<Time> stamps = every(10 * ms, 500);
    // Four usual steps ahead: the limit beyond which a stamp counts as wild.
    std::rotate(stamps.begin() + 220, stamps.begin() + 223, stamps.begin() + 224);
    Recording recording;
    recording.streams = {recorded("points", points({"a"}, stamps, wander)),
                         recorded("kinect", points({"a"}, every(33 * ms, 200, -500 * ms), wander))};
    recording.streams[0].clock.pieces.front().begin = stamps.front();
    recording.streams[0].clock.pieces.front().drift_ppm = drift;
    const auto take = align(recording, own_space());
    if (!take) FAIL_CHECK(to_string(take.error()));
  }
}

TEST_CASE("a joint that is out of view across the take's end is a gap in blocks of any size") {
  PointStream kinect = points({"a"}, every(33 * ms, 1000), wander);
  for (std::size_t t = 0; t < 1000; ++t) {
    if (t * 33 > 8'000 && t * 33 < 22'000) kinect.frames.state[t] = Tracking::missing;
  }
  const RecordedStream other = recorded("kinect", kinect);
  for (const std::size_t size : {1U, 7U, 100U, 1000U}) {
    CAPTURE(size);
    Recording recording;
    recording.streams = {recorded("points", points({"a"}, every(10 * ms, 1001), wander)),
                         read_in_blocks(other, kinect.frames, size)};
    const auto take = align(recording, own_space());
    REQUIRE(take);
    CHECK(take->report.streams[1].gaps == 1);
    CHECK(take->report.streams[1].gap_time_ns == 10'000 * ms - 242 * 33 * ms);
  }
}

TEST_CASE(
    "a slow stream that begins long before the take has the same rows in blocks of any size") {
  for (const std::int64_t step_ms : {500, 1000, 2000, 5000}) {
    CAPTURE(step_ms);
    const PointStream kinect =
        points({"a"}, every(step_ms * ms, static_cast<std::size_t>(90'000 / step_ms), -60'000 * ms),
               wander);
    const RecordedStream other = recorded("kinect", kinect);
    const auto aligned = [&](std::size_t size) {
      Recording recording;
      recording.streams = {recorded("points", points({"a"}, every(10 * ms, 2000), wander)),
                           read_in_blocks(other, kinect.frames, size)};
      auto take = align(recording, own_space());
      REQUIRE(take);
      return *std::move(take);
    };
    check_same(aligned(1), aligned(kinect.frames.size()));
  }
}
