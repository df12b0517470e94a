// SPDX-License-Identifier: Apache-2.0
// A skeleton's stream at another stream's stamps: rotations by the chosen curve, positions from the
// skeleton, and no rows across a gap.
#include "tests/align/streams.h"

#include "kinalign/align/align.h"
#include "kinalign/align/own_rows.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/motion/interpolation/slerp.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// A leg that swings under a hip that sways and turns.
Clip swinging(const std::vector<Time>& stamps) {
  Clip clip;
  clip.skeleton = {{"Hips", "Leg"}, {-1, 0}, {Vec3::Zero(), Vec3(0, -0.5, 0)}, {}};
  clip.frames.stamps = stamps;
  for (const Time stamp : stamps) {
    const double t = 1e-9 * static_cast<double>(to_ns(stamp));
    for (const double x : {std::sin(t), 1.0, 0.0, 0.0, -0.5, 0.01 * t}) {
      clip.frames.local_positions.push_back(x);
    }
    for (const Quat& q : {Quat(Eigen::AngleAxisd(2.0 * std::sin(3.0 * t), Vec3::UnitY())),
                          Quat(Eigen::AngleAxisd(std::cos(5.0 * t), Vec3::UnitX()))}) {
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        clip.frames.local_rotations.push_back(part);
      }
    }
  }
  return clip;
}

Take aligned(const Clip& clip, const Manifest& manifest = {}) {
  Recording recording;
  recording.streams = {recorded("optical", points({"a"}, every(10 * ms, 300), wander)),
                       recorded("mocap", clip)};
  const auto take = align(recording, manifest);
  REQUIRE_MESSAGE(take, (take ? "" : to_string(take.error())));
  return *take;
}

const ClipRows& mocap(const Take& take) { return std::get<ClipRows>(take.all.rows[1]); }

std::vector<double> seconds_of(const std::vector<Time>& stamps) {
  std::vector<double> out;
  for (const Time t : stamps) out.push_back(1e-9 * static_cast<double>(to_ns(t)));
  return out;
}

/// Largest angle, rad, between the leg's rows and slerp between its samples.
double from_slerp(const Clip& clip, const Take& take) {
  std::vector<double> leg;
  for (std::size_t t = 0; t < clip.frames.size(); ++t) {
    const double* q = &clip.frames.local_rotations[8 * t + 4];
    leg.insert(leg.end(), q, q + 4);
  }
  const auto times = seconds_of(clip.frames.stamps), rows = seconds_of(take.all.stamps);
  std::vector<double> turned(4 * rows.size());
  slerp_at(times, leg, rows, turned);
  double most = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    most = std::max(most,
                    quat(turned, r).angularDistance(quat(mocap(take).local_rotations, 2 * r + 1)));
  }
  return most;
}

}  // namespace

TEST_CASE("rotations = slerp turns at constant rates between samples, the spline does not") {
  const Clip clip = swinging(every(45 * ms, 66));
  Manifest manifest;
  manifest.align.rotations = "slerp";
  CHECK(from_slerp(clip, aligned(clip, manifest)) < 1e-7);
  CHECK(from_slerp(clip, aligned(clip)) > 1e-3);
}

TEST_CASE("by either curve a row on a sample is that sample") {
  const Clip clip = swinging(every(30 * ms, 99));
  for (const char* curve : {"slerp", "spline"}) {
    CAPTURE(std::string(curve));
    Manifest manifest;
    manifest.align.rotations = curve;
    const Take take = aligned(clip, manifest);
    for (std::size_t r = 0; r < take.all.stamps.size(); r += 3) {
      for (std::size_t j = 0; j < 2; ++j) {
        const Quat is = quat(mocap(take).local_rotations, 2 * r + j);
        CHECK(is.angularDistance(quat(clip.frames.local_rotations, 2 * (r / 3) + j)) < 1e-7);
        CHECK(is.norm() == doctest::Approx(1.0).epsilon(1e-12));
      }
      CHECK(mocap(take).distance.nearest_raw_ns[r] == 0);
    }
  }
}

TEST_CASE("across a gap a clip has no pose: rows are there, invalid and zero") {
  auto stamps = every(30 * ms, 99);
  stamps.erase(stamps.begin() + 40, stamps.begin() + 50);  // 1170 to 1500 ms
  const Take take = aligned(swinging(stamps));
  const ClipRows& rows = mocap(take);
  REQUIRE(rows.valid.size() == take.all.stamps.size());
  for (std::size_t r = 0; r < rows.valid.size(); ++r) {
    const bool in_gap = r > 117 && r < 150;
    CHECK(rows.valid[r] == (in_gap ? 0 : 1));
    for (std::size_t k = 0; k < 6; ++k) {
      if (!in_gap) continue;
      CHECK(rows.positions[6 * r + k] == 0.0);
      CHECK(rows.local_positions[6 * r + k] == 0.0);
    }
    for (std::size_t k = 0; in_gap && k < 8; ++k) CHECK(rows.local_rotations[8 * r + k] == 0.0);
  }
  CHECK(take.report.streams[1].invalid == 32);
  CHECK(take.report.streams[1].gaps == 1);
  CHECK(take.report.streams[1].gap_time_ns == 330 * ms);
}

TEST_CASE("places are the skeleton's of the row's own turns, in every valid row") {
  const Clip clip = swinging(every(33 * ms, 90));
  const Take take = aligned(clip);
  const ClipRows& rows = mocap(take);
  for (std::size_t r = 0; r < rows.valid.size(); ++r) {
    const auto local = [&](std::size_t j) {
      return Vec3(vec3(std::span<const double>(rows.local_positions), 2 * r + j));
    };
    const Vec3 leg = local(0) + quat(rows.local_rotations, 2 * r) * local(1);
    const auto place = [&](std::size_t j) {
      return Vec3(vec3(std::span<const double>(rows.positions), 2 * r + j));
    };
    CHECK((place(0) - local(0)).norm() < 1e-15);
    CHECK((place(1) - leg).norm() < 1e-12);
  }
}

TEST_CASE("a clip that is the reference keeps its frames to the last bit") {
  const Clip clip = swinging(every(16'666'667, 100));
  Recording recording;
  recording.streams = {recorded("mocap", clip)};
  const auto take = align(recording, {});
  REQUIRE(take);
  const auto& rows = std::get<ClipRows>(take->all.rows[0]);
  CHECK(take->all.stamps == clip.frames.stamps);
  CHECK(rows.local_positions == clip.frames.local_positions);
  CHECK(rows.local_rotations == clip.frames.local_rotations);
  CHECK(rows.valid.empty());
  std::vector<double> global(rows.positions.size());
  forward_kinematics(clip.skeleton, clip.frames, global);
  CHECK(rows.positions == global);
  CHECK(own_rows(clip.skeleton, clip.frames).positions == global);
}
