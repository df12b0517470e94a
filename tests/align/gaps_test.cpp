// SPDX-License-Identifier: Apache-2.0
// Which rows of a take hold data, and what the report says about them: compared with a plain loop
// over all samples for every cell.
#include "tests/align/two_streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

#include <optional>

using namespace kinalign;
using namespace kinalign::test;

namespace {

constexpr std::int64_t step = 33 * ms;

/// A Kinect that loses frames and joints, in runs of all lengths.
PointStream with_losses(std::mt19937_64& random) {
  std::vector<Time> stamps;
  std::int64_t t = 0;
  for (int i = 0; i < 150; ++i) {
    stamps.push_back(utc_time(t));
    t += step * static_cast<std::int64_t>(random() % 12 == 0 ? 1 + random() % 9 : 1) +
         static_cast<std::int64_t>(random() % 5) * ms;
  }
  PointStream out = points(joints, stamps, wander);
  for (std::size_t cell = 0; cell < out.frames.state.size(); ++cell) {
    if (random() % 4 != 0) continue;
    out.frames.state[cell] = random() % 2 == 0 ? Tracking::missing : Tracking::inferred;
    if (out.frames.state[cell] == Tracking::missing) {
      std::fill_n(&out.frames.positions[3 * cell], 3, 0.0);
    }
  }
  return out;
}

/// A cell of a take, computed by a plain loop over the samples.
struct Cell {
  bool valid = false;
  bool bridged = false;
  Tracking state = Tracking::missing;
};

struct Kinect {
  const PointFrames& frames;
  std::int64_t gap_ns, step_ns;

  std::int64_t time(std::size_t i) const { return to_ns(frames.stamps[i]); }
  Tracking state(std::size_t i, std::size_t j) const { return frames.state[i * joints.size() + j]; }

  Cell cell(std::int64_t row, std::size_t j) const {
    std::optional<std::int64_t> before, behind;  // nearest samples of this joint
    std::size_t left = 0, right = frames.size() - 1;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (time(i) <= row) left = i;
      if (state(i, j) == Tracking::missing) continue;
      if (time(i) <= row) before = time(i);
      if (time(i) >= row && !behind) behind = time(i);
    }
    for (std::size_t i = frames.size(); i-- > 0;) {
      if (time(i) >= row) right = i;
    }
    Cell out;
    out.valid = before && behind && *behind - *before <= gap_ns;
    if (!out.valid) return out;
    out.state = std::min(state(left, j), state(right, j));
    out.bridged = out.state == Tracking::missing || 2 * (time(right) - time(left)) > 3 * step_ns;
    return out;
  }

  std::int64_t nearest(std::int64_t row) const {
    std::int64_t out = farthest_nearest_ns;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      bool seen = false;
      for (std::size_t j = 0; j < joints.size(); ++j) seen |= state(i, j) != Tracking::missing;
      if (seen) out = std::min(out, std::abs(time(i) - row));
    }
    return out;
  }
};

}  // namespace

TEST_CASE("a cell is valid just where both neighbouring samples of its joint are near enough") {
  for (const std::uint64_t seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const PointStream kinect = with_losses(random);
    Manifest manifest = own_space();
    manifest.align.gap_ms = random() % 2 == 0 ? 0.0 : 40.0 + static_cast<double>(random() % 300);
    const auto take = align(two(points(joints, every(10 * ms, 600), wander), kinect), manifest);
    REQUIRE(take);
    const StreamReport& report = take->report.streams[1];
    const std::int64_t median = report.survey.median_step_ns;
    const std::int64_t gap = manifest.align.gap_ms > 0.0
                                 ? static_cast<std::int64_t>(manifest.align.gap_ms * 1e6)
                                 : 3 * median + median / 10;
    CHECK(report.gap_ns == gap);
    const Kinect truth{kinect.frames, gap, median};
    const PointRows& out = rows(*take, 1);
    std::uint64_t invalid = 0, inferred = 0, bridged = 0;
    std::int64_t worst = 0;
    for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
      const std::int64_t row = to_ns(take->all.stamps[r]);
      CHECK(out.distance.nearest_raw_ns[r] == truth.nearest(row));
      for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::size_t cell = r * joints.size() + j;
        const Cell expected = truth.cell(row, j);
        CHECK(out.valid[cell] == (expected.valid ? 1 : 0));
        CHECK(out.state[cell] == expected.state);
        if (!expected.valid) CHECK(at(out, r, j) == Vec3::Zero());
        invalid += expected.valid ? 0 : 1;
        inferred += expected.state == Tracking::inferred ? 1 : 0;
        bridged += expected.bridged ? 1 : 0;
        if (expected.valid) worst = std::max(worst, truth.nearest(row));
      }
    }
    CHECK(report.samples == out.valid.size());
    CHECK(report.invalid == invalid);
    CHECK(report.inferred == inferred);
    CHECK(report.bridged == bridged);
    CHECK(report.worst_nearest_ns == worst);
  }
}

TEST_CASE("what is valid runs through its own samples and through no others") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const PointStream kinect = with_losses(random);
    PointStream astray = kinect;  // a device may write anything for a joint that it did not see
    for (std::size_t cell = 0; cell < astray.frames.state.size(); ++cell) {
      if (astray.frames.state[cell] != Tracking::missing) continue;
      std::fill_n(&astray.frames.positions[3 * cell], 3, 1e6);
    }
    const auto reference = points(joints, kinect.frames.stamps, wander);
    const auto take = align(two(reference, kinect), own_space());
    const auto other = align(two(reference, astray), own_space());
    REQUIRE(take);
    REQUIRE(other);
    CHECK(rows(*take, 1).positions == rows(*other, 1).positions);
    for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
      for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::size_t cell = r * joints.size() + j;
        if (kinect.frames.state[cell] == Tracking::missing) continue;
        CHECK((at(rows(*take, 1), r, j) - vec3(kinect.frames.positions, cell)).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("the gaps of a report are the stretches without a sample within the take") {
  const auto report_of = [](std::vector<Time> stamps) {
    const auto take = align(
        two(points(joints, every(10 * ms, 101, 1000 * ms), wander), points(joints, stamps, wander)),
        own_space());
    REQUIRE(take);
    return take->report.streams[1];
  };
  // Rows first to last - 1 of stamps at 0, 20, ... 3000 ms are left out.
  const auto without = [](std::size_t first, std::size_t last) {
    auto stamps = every(20 * ms, 151);
    stamps.erase(stamps.begin() + static_cast<std::ptrdiff_t>(first),
                 stamps.begin() + static_cast<std::ptrdiff_t>(last));
    return stamps;
  };
  CHECK(report_of(without(0, 0)).gaps == 0);
  const auto inside = report_of(without(60, 70));  // 1180 to 1400 ms
  CHECK(inside.gaps == 1);
  CHECK(inside.gap_time_ns == 220 * ms);
  const auto across_the_start = report_of(without(40, 60));  // 780 to 1200 ms
  CHECK(across_the_start.gaps == 1);
  CHECK(across_the_start.gap_time_ns == 200 * ms);
  const auto across_the_end = report_of(without(95, 120));  // 1880 to 2400 ms
  CHECK(across_the_end.gap_time_ns == 120 * ms);
  CHECK(report_of(without(10, 20)).gaps == 0);    // before the take
  CHECK(report_of(without(120, 130)).gaps == 0);  // after the take
}
