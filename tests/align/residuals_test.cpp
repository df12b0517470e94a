// SPDX-License-Identifier: Apache-2.0
// Equations (1) and (2) compared with their printed form, and the report's figures compared with
// plain sums over the take.
#include "tests/align/two_streams.h"
#include "tests/seeds.h"

#include "kinalign/align/align.h"
#include "kinalign/align/space.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace kinalign;
using namespace kinalign::test;

namespace {

/// Optical points and a Kinect on the same stamps, both anywhere; the Kinect loses `lost` of 100.
Recording unrelated(std::mt19937_64& random, std::uint64_t lost) {
  const auto anywhere = [&](std::size_t, double) { return any_vector(random, 2); };
  PointStream optical = points(joints, every(10 * ms, 200), anywhere);
  PointStream kinect = points(joints, every(10 * ms, 200), anywhere);
  for (auto& state : kinect.frames.state) {
    if (random() % 100 < lost) state = random() % 3 == 0 ? Tracking::inferred : Tracking::missing;
  }
  return two(std::move(optical), std::move(kinect));
}

/// The same take with no stream moved.
Take unmoved(const Recording& recording) {
  const auto take = align(recording, own_space());
  REQUIRE(take);
  return *take;
}

}  // namespace

TEST_CASE("equations (1) and (2) as printed, in every frame, for any A_rot and m") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Recording recording = unrelated(random, 15);
    Manifest manifest;
    SpaceOptions& paper = manifest.spaces["kinect"];
    paper.method = "paper";
    paper.onto_root = "Head";
    paper.rotation_y_deg = 360.0 * any_vector(random, 2).x();
    paper.magnification = 0.5 + static_cast<double>(random() % 100) / 50.0;
    const auto take = align(recording, manifest);
    REQUIRE(take);
    const Take raw = unmoved(recording);
    // A_rot, counter-clockwise seen from +y: section 3.1
    const double a = paper.rotation_y_deg * std::acos(-1.0) / 180.0;
    Eigen::Matrix3d a_rot;
    a_rot << std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a);
    const double m = paper.magnification;
    const PointRows &out = rows(*take, 1), &in = rows(raw, 1);
    for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
      const bool placed = in.valid[r * joints.size()] != 0;
      const Vec3 offset = a_rot * at(in, r, 0) - at(rows(raw, 0), r, 1) / m;
      for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::size_t cell = r * joints.size() + j;
        const bool valid = placed && in.valid[cell] != 0;
        CHECK(out.valid[cell] == (valid ? 1 : 0));
        CHECK(out.state[cell] == (valid ? in.state[cell] : Tracking::missing));
        const Vec3 printed = m * (a_rot * at(in, r, j) - offset);
        CHECK((at(out, r, j) - (valid ? printed : Vec3::Zero())).norm() < 1e-12);
      }
    }
    const SpaceReport& report = take->report.spaces.at(0);
    CHECK(report.transform.rotation.toRotationMatrix().isApprox(a_rot, 1e-12));
    CHECK(report.magnification == m);
  }
}

TEST_CASE("what the report counts is what the take holds, also where the root was lost") {
  for (const char* method : {"none", "fit", "paper"}) {
    CAPTURE(method);
    std::mt19937_64 random(3);
    const Recording recording = unrelated(random, 30);
    Manifest manifest;
    manifest.spaces["kinect"].method = method;
    if (std::string_view(method) == "paper") manifest.spaces["kinect"].onto_root = "Head";
    const auto take = align(recording, manifest);
    REQUIRE(take);
    const auto count = [](const auto& values, auto value) {
      return static_cast<std::uint64_t>(std::count(values.begin(), values.end(), value));
    };
    for (const std::size_t stream : {0U, 1U}) {  // the reference too
      const PointRows& out = rows(*take, stream);
      const StreamReport& report = take->report.streams[stream];
      CHECK(report.samples == out.valid.size());
      CHECK(report.invalid == count(out.valid, 0));
      CHECK(report.inferred == count(out.state, Tracking::inferred));
    }
    const PointRows& out = rows(*take, 1);
    std::int64_t worst = 0;
    std::uint64_t bridged = 0;
    for (std::size_t cell = 0; cell < out.valid.size(); ++cell) {
      if (out.valid[cell] == 0) continue;
      worst = std::max(worst, out.distance.nearest_raw_ns[cell / joints.size()]);
      bridged += out.state[cell] == Tracking::missing ? 1 : 0;  // no cell is lost on equal stamps
    }
    CHECK(take->report.streams[1].worst_nearest_ns == worst);
    CHECK(take->report.streams[1].bridged == bridged);
  }
}

TEST_CASE("a reference of points has figures: what it lost and what it guessed") {
  PointStream optical = points(joints, every(10 * ms, 100), wander);
  optical.frames.state[4] = Tracking::missing;
  optical.frames.state[9] = Tracking::inferred;
  const auto take = align({"", "", {recorded("optical", std::move(optical))}}, {});
  REQUIRE(take);
  const StreamReport& report = take->report.streams.at(0);
  CHECK(report.samples == 400);
  CHECK(report.invalid == 1);
  CHECK(report.inferred == 1);
  CHECK(report.bridged == 0);
}

TEST_CASE("residuals are root mean squares over the rows in which both joints were seen") {
  for (const std::uint64_t seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Recording recording = unrelated(random, 20);
    Manifest manifest;
    manifest.spaces["kinect"].method = "fit";
    const auto take = align(recording, manifest);
    REQUIRE(take);
    const Take raw = unmoved(recording);
    const SpaceReport& report = take->report.spaces.at(0);
    REQUIRE(report.joints.size() == joints.size());
    double before_all = 0.0, after_all = 0.0;
    std::uint64_t rows_all = 0;
    for (const JointResidual& joint : report.joints) {
      CHECK(joint.joint == joint.onto);
      const auto j = static_cast<std::size_t>(std::find(joints.begin(), joints.end(), joint.joint) -
                                              joints.begin());
      double before = 0.0, after = 0.0;
      std::uint64_t seen = 0;
      for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
        if (rows(*take, 1).state[r * joints.size() + j] != Tracking::tracked) continue;
        ++seen;
        before += (at(rows(raw, 1), r, j) - at(rows(raw, 0), r, j)).squaredNorm();
        after += (at(rows(*take, 1), r, j) - at(rows(*take, 0), r, j)).squaredNorm();
      }
      CHECK(joint.rows == seen);
      const auto n = static_cast<double>(seen);
      CHECK(joint.before_m == doctest::Approx(std::sqrt(before / n)).epsilon(1e-12));
      CHECK(joint.after_m == doctest::Approx(std::sqrt(after / n)).epsilon(1e-12));
      before_all += before;
      after_all += after;
      rows_all += seen;
    }
    const auto n = static_cast<double>(rows_all);
    CHECK(report.before_m == doctest::Approx(std::sqrt(before_all / n)).epsilon(1e-12));
    CHECK(report.after_m == doctest::Approx(std::sqrt(after_all / n)).epsilon(1e-12));
    CHECK(std::is_sorted(report.joints.begin(), report.joints.end(),
                         [](const auto& a, const auto& b) { return a.after_m > b.after_m; }));
    CHECK(report.after_m <= report.before_m);
  }
}

TEST_CASE("a fit onto a stream that is not the reference lies in that stream's space") {
  const auto turned = [](std::size_t j, double t) { return Vec3(turn_about_y(40) * wander(j, t)); };
  Recording recording =
      two(points(joints, every(10 * ms, 200), wander), points(joints, every(10 * ms, 200), turned));
  recording.streams.push_back(recorded("second", points(joints, every(10 * ms, 200), wander)));
  Manifest manifest;
  manifest.spaces["kinect"].method = "none";
  manifest.spaces["second"].method = "fit";
  manifest.spaces["second"].onto = "kinect";
  const auto take = align(recording, manifest);
  REQUIRE(take);
  CHECK(take->header.groups[0].space == "take");
  CHECK(take->header.groups[1].space == "kinect");
  CHECK(take->header.groups[2].space == "kinect");
  CHECK(take->report.spaces.at(0).onto == "kinect");
  CHECK((at(rows(*take, 2), 77, 1) - at(rows(*take, 1), 77, 1)).norm() < 1e-9);
}

TEST_CASE("a turn about y is counter-clockwise seen from above: z comes to x, x goes to -z") {
  CHECK((turn_about_y(90) * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-15);
  CHECK((turn_about_y(90) * Vec3::UnitX() + Vec3::UnitZ()).norm() < 1e-15);
  CHECK((turn_about_y(60) * Vec3::UnitY() - Vec3::UnitY()).norm() < 1e-15);
}
