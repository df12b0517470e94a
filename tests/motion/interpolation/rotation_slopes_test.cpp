// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/rotation_slopes.h"

#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <random>

using namespace kinalign;

namespace {

RotationIntervals between(const std::vector<double>& times, const std::vector<double>& knots) {
  RotationIntervals intervals;
  measure_intervals({times, knots}, intervals);
  return intervals;
}

RotationSlopes room(const RotationIntervals& intervals) {
  RotationSlopes slopes;
  for (auto& column : slopes.begin) column.assign(intervals.size(), -7.0);
  for (auto& column : slopes.end) column.assign(intervals.size(), -7.0);
  return slopes;
}

/// Largest difference, rad per interval.
double worst_difference(const RotationIntervals& in, const Columns& a, const Columns& b) {
  double worst = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < in.size(); ++k) {
      worst = std::max(worst, in.length[k] * std::abs(a[axis][k] - b[axis][k]));
    }
  }
  return worst;
}

void check_both_ways(const std::vector<double>& times, const std::vector<double>& knots) {
  const RotationIntervals in = between(times, knots);
  RotationSlopes lanes = room(in), blocks = room(in);
  REQUIRE(slopes_in_lanes(in, lanes));
  slopes_by_blocks(in, blocks);
  // Either stops when its estimate of the error is 1e-13.
  CHECK(worst_difference(in, lanes.begin, blocks.begin) <= 1e-12);
  CHECK(worst_difference(in, lanes.end, blocks.end) <= 1e-12);
}

}  // namespace

TEST_CASE("near knots have the same slopes in lanes and by blocks") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const std::size_t n = 266 + random() % 1000;
    const auto jittery = jittery_stamps(n, random), irregular = irregular_stamps(n, random);
    check_both_ways(jittery, smooth_rotations(jittery));
    check_both_ways(irregular, smooth_rotations(irregular));
    for (const double most : {0.0, 1e-6, 0.1, 0.3}) {
      CAPTURE(most);
      check_both_ways(jittery, rotation_walk(n, most, random));
      check_both_ways(irregular, rotation_walk(n, most, random));
    }
  }
}

TEST_CASE("lanes leave few and far knots to blocks") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto few = jittery_stamps(2 + random() % 264, random);
    const auto many = irregular_stamps(266 + random() % 1000, random);
    const RotationIntervals near = between(few, smooth_rotations(few));
    const RotationIntervals far = between(many, rotation_walk(many.size(), 3.0, random));
    RotationSlopes slopes = room(near);
    CHECK(!slopes_in_lanes(near, slopes));
    slopes = room(far);
    CHECK(!slopes_in_lanes(far, slopes));
  }
}

TEST_CASE("the parts of a turn are what they are made from") {
  for (const Vec3& v : awkward_vectors()) {
    if (v.norm() > std::numbers::pi) continue;
    CAPTURE(v.transpose());
    const TurnParts parts = turn_parts(v.squaredNorm());
    const Vec3 half = parts.half_r * v;
    const Quat turned(parts.half_w, half.x(), half.y(), half.z());
    CHECK(angle_between(turned, rotation(0.5 * v)) <= 1e-15);
    // A component along the vector is not changed.
    CHECK(parts.across + parts.along * v.squaredNorm() == doctest::Approx(1.0).epsilon(1e-15));
    CHECK(parts.square + parts.product * v.squaredNorm() ==
          doctest::Approx(parts.mixed).epsilon(1e-14));
  }
}
