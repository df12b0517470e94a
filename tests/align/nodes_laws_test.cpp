// SPDX-License-Identifier: Apache-2.0
// Rules for nodes: each node keeps its own samples, and turns for mountings and roots can be
// undone.
#include "tests/align/streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"
#include "kinalign/align/marks.h"
#include "kinalign/align/nodes.h"
#include "kinalign/motion/arrays.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

using namespace kinalign;
using namespace kinalign::test;

namespace {

Quat any_turn(std::mt19937_64& random) {
  const Vec3 axis = any_vector(random, 9);
  return Quat(Eigen::AngleAxisd(any_vector(random, 9).x(), axis.normalized()));
}

/// Rows of nodes that measure all, of which one in six samples is not valid and holds zeros.
ImuRows any_rows(std::size_t rows, std::size_t nodes, std::mt19937_64& random) {
  ImuRows out;
  out.valid.resize(rows * nodes);
  out.orientation.resize(4 * rows * nodes);
  out.acceleration.resize(3 * rows * nodes);
  out.angular_velocity.resize(3 * rows * nodes);
  for (std::size_t i = 0; i < rows * nodes; ++i) {
    if (random() % 6 == 0) continue;
    out.valid[i] = 1;
    put_quat(out.orientation, i, any_turn(random));
    vec3(std::span(out.acceleration), i) = any_vector(random, 9);
    vec3(std::span(out.angular_velocity), i) = any_vector(random, 9);
  }
  return out;
}

Vec3 acceleration(const ImuRows& rows, std::size_t i) {
  return vec3(std::span<const double>(rows.acceleration), i);
}
Vec3 angular_velocity(const ImuRows& rows, std::size_t i) {
  return vec3(std::span<const double>(rows.angular_velocity), i);
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return a.size() == b.size() ? most : 1e300;
}

const ImuGroup three{{"waist", "left", "right"}, {true, true, true, true}, "left"};

}  // namespace

TEST_CASE("from the root's space every node turns back into the world, as it was") {
  for (const std::uint64_t seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const ImuRows world = any_rows(20, 3, random);
    ImuRows rows = world;
    bring_to_root(three, rows);
    for (std::size_t r = 0; r < 20; ++r) {
      const std::size_t root = 3 * r + 1;
      for (std::size_t i = 3 * r; i < 3 * r + 3; ++i) {
        const bool valid = world.valid[root] != 0 && world.valid[i] != 0;
        CHECK(rows.valid[i] == (valid ? 1 : 0));
        if (!valid) {
          CHECK(acceleration(rows, i) == Vec3::Zero());
          CHECK(angular_velocity(rows, i) == Vec3::Zero());
          CHECK(quat(rows.orientation, i).norm() == 0.0);
          continue;
        }
        const Quat turn = quat(world.orientation, root);
        const Vec3 of_root = i == root ? Vec3::Zero() : acceleration(world, root);
        const Quat back = i == root ? turn : turn * quat(rows.orientation, i);
        CHECK(back.angularDistance(quat(world.orientation, i)) < 1e-7);
        CHECK((turn * acceleration(rows, i) + of_root - acceleration(world, i)).norm() < 1e-12);
        CHECK((turn * angular_velocity(rows, i) - angular_velocity(world, i)).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("nodes come back from the root's space, with their vectors in their own spaces") {
  for (const std::uint64_t seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const ImuRows world = any_rows(20, 3, random);
    ImuRows rows = world;
    bring_to_root(three, rows);
    const std::vector<std::uint8_t> valid = rows.valid;
    bring_from_root(three, rows);
    CHECK(rows.valid == valid);
    for (std::size_t i = 0; i < valid.size(); ++i) {
      if (valid[i] == 0) continue;
      const Quat turn = quat(world.orientation, i);
      CHECK(quat(rows.orientation, i).angularDistance(turn) < 1e-7);
      CHECK((turn * acceleration(rows, i) - acceleration(world, i)).norm() < 1e-12);
      CHECK((turn * angular_velocity(rows, i) - angular_velocity(world, i)).norm() < 1e-12);
    }
  }
}

TEST_CASE("a mounting and its inverse cancel, and no mounting changes nothing") {
  ImuGroup group = three;
  for (const char* root : {"", "left"}) {
    group.root_node = root;
    for (const std::uint64_t seed : fresh_seeds(50)) {
      CAPTURE(seed);
      std::mt19937_64 random(seed);
      const ImuRows before = any_rows(10, 3, random);
      const Quat q = any_turn(random);
      ImuRows rows = before;
      apply_mounting(group, {}, rows);
      CHECK(rows.orientation == before.orientation);
      apply_mounting(group, {{"right", {q.w(), q.x(), q.y(), q.z()}}}, rows);
      apply_mounting(group, {{"right", {q.w(), -q.x(), -q.y(), -q.z()}}}, rows);
      CHECK(apart(rows.orientation, before.orientation) < 1e-14);
      CHECK(apart(rows.acceleration, before.acceleration) < 1e-13);
      CHECK(apart(rows.angular_velocity, before.angular_velocity) < 1e-13);
      CHECK(rows.valid == before.valid);
    }
  }
}

TEST_CASE("streams of one group stand side by side, each in its columns, and are counted there") {
  std::mt19937_64 random(5);
  const ImuRows two = any_rows(7, 2, random), one = any_rows(7, 1, random);
  ImuRows group;
  put_nodes(two, 7, {0, 3}, group);
  put_nodes(one, 7, {2, 3}, group);
  std::uint64_t lost_of_two = 0, lost_of_one = 0;
  for (std::size_t r = 0; r < 7; ++r) {
    for (std::size_t s = 0; s < 3; ++s) {
      const ImuRows& from = s < 2 ? two : one;
      const std::size_t i = s < 2 ? 2 * r + s : r;
      CHECK(group.valid[3 * r + s] == from.valid[i]);
      CHECK(acceleration(group, 3 * r + s) == acceleration(from, i));
      CHECK(angular_velocity(group, 3 * r + s) == angular_velocity(from, i));
      CHECK(quat(group.orientation, 3 * r + s).coeffs() == quat(from.orientation, i).coeffs());
      (s < 2 ? lost_of_two : lost_of_one) += from.valid[i] == 0 ? 1 : 0;
    }
  }
  Marks of_two, of_one;
  add_marks(group, {0, 3}, 2, of_two);
  add_marks(group, {2, 3}, 1, of_one);
  CHECK(of_two.samples == 14);
  CHECK(of_two.invalid == lost_of_two);
  CHECK(of_one.samples == 7);
  CHECK(of_one.invalid == lost_of_one);
}

TEST_CASE("each node is valid where its own samples are near enough, whatever the others lost") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    auto stamps = every(20 * ms, 100);
    for (Time& stamp : stamps) stamp += Duration{static_cast<std::int64_t>(random() % 9) * ms};
    ImuStream imu = nodes({"waist", "left", "right"}, stamps, [](std::size_t, double t) {
      return Quat(Eigen::AngleAxisd(t, Vec3::UnitY()));
    });
    for (std::size_t s = 0; s < 3; ++s) {
      bool lost = false;
      for (std::size_t t = 0; t < 100; ++t) {
        if (random() % 4 == 0) lost = !lost;
        if (lost) imu.samples.valid[3 * t + s] = 0;
      }
    }
    Recording recording;
    recording.streams = {recorded("optical", points({"a"}, every(7 * ms, 280), wander)),
                         recorded("imu", imu)};
    Manifest manifest;
    manifest.align.gap_ms = 61.0;
    manifest.streams.resize(1);
    manifest.streams[0].name = "imu";
    manifest.streams[0].rate_hz = 50.0;
    const auto take = align(recording, manifest);
    REQUIRE(take);
    const auto& rows = std::get<ImuRows>(take->all.rows[1]);
    std::uint64_t invalid = 0, bridged = 0;
    for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
      const std::int64_t row = to_ns(take->all.stamps[r]);
      for (std::size_t s = 0; s < 3; ++s) {
        std::optional<std::int64_t> before, behind;
        for (std::size_t t = 0; t < 100; ++t) {
          if (imu.samples.valid[3 * t + s] == 0) continue;
          const std::int64_t at = to_ns(imu.samples.stamps[t]);
          if (at <= row) before = at;
          if (at >= row && !behind) behind = at;
        }
        const bool valid = before && behind && *behind - *before <= 61 * ms;
        CHECK(rows.valid[3 * r + s] == (valid ? 1 : 0));
        invalid += valid ? 0 : 1;
        bridged += valid && *behind - *before > 30 * ms ? 1 : 0;
        if (!valid) CHECK(acceleration(rows, 3 * r + s) == Vec3::Zero());
        std::int64_t nearest = farthest_nearest_ns;
        if (before) nearest = std::min(nearest, row - *before);
        if (behind) nearest = std::min(nearest, *behind - row);
        CHECK(rows.distance.nearest_raw_ns[3 * r + s] == nearest);
      }
    }
    CHECK(take->report.streams[1].samples == rows.valid.size());
    CHECK(take->report.streams[1].invalid == invalid);
    CHECK(take->report.streams[1].bridged == bridged);
  }
}
