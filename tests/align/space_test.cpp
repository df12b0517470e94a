// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/space.h"

#include "tests/align/two_streams.h"

#include "kinalign/align/align.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;
using namespace kinalign::test;

TEST_CASE("a rigid fit once per take finds a camera's place and turn") {
  const Quat turn = turn_about_y(-58.7);
  const Vec3 place(0.4, -0.9, 2.5);
  const auto seen = [&](std::size_t j, double t) { return Vec3(turn * wander(j, t) + place); };
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  const auto take = align(
      two(points(joints, every(10 * ms, 3000), wander), points(joints, every(30 * ms, 1000), seen)),
      manifest);
  REQUIRE(take);
  REQUIRE(take->report.spaces.size() == 1);
  const SpaceReport& space = take->report.spaces[0];
  CHECK(space.transform.rotation.angularDistance(turn.conjugate()) < 1e-5);
  CHECK(space.after_m < 2e-4);  // the rest is the splines' error at their ends
  CHECK(space.before_m > 2.0);
  CHECK(space.joints.size() == 4);
  for (std::size_t r = 100; r < 2900; ++r) {
    CHECK((at(rows(*take, 1), r, 2) - at(rows(*take, 0), r, 2)).norm() < 1e-4);
  }
}

TEST_CASE("without named joints a Kinect is fitted by the places that both skeletons have") {
  // Both skeletons have a Neck and a Head, but at different places, so these must not be paired by
  // name.
  const std::vector<std::string> kinect{"SpineBase", "Neck", "Head", "KneeLeft", "WristLeft"};
  const std::vector<std::string> mocap{"Hips", "Neck", "Head", "LeftLeg", "LeftHand"};
  const auto higher = [](std::size_t j, double t) {
    return Vec3(wander(j, t) + (j == 1 || j == 2 ? Vec3(0.0, 0.1, 0.0) : Vec3::Zero()));
  };
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  const auto take = align(
      two(points(mocap, every(10 * ms, 300), higher), points(kinect, every(10 * ms, 300), wander)),
      manifest);
  REQUIRE(take);
  CHECK(take->report.spaces.at(0).joints.size() == 3);
  CHECK(take->report.spaces.at(0).after_m < 1e-9);
}

TEST_CASE("equations (1) and (2): in every frame the root lies on the mocap's root") {
  const auto seen = [](std::size_t j, double t) {
    return Vec3(turn_about_y(-60.0) * wander(j, t) + Vec3(0.3 * std::sin(5.0 * t), -0.9, 2.5));
  };
  Manifest manifest;
  SpaceOptions& paper = manifest.spaces["kinect"];
  paper.method = "paper";
  paper.onto_root = "SpineBase";
  for (const double m : {1.0, 1.25}) {
    paper.magnification = m;
    const auto take = align(
        two(points(joints, every(10 * ms, 300), wander), points(joints, every(30 * ms, 100), seen)),
        manifest);
    REQUIRE(take);
    for (std::size_t r = 0; r < take->all.stamps.size(); ++r) {
      const Vec3 root = at(rows(*take, 0), r, 0);
      CHECK((at(rows(*take, 1), r, 0) - root).norm() < 1e-12);
      const double t = 1e-9 * static_cast<double>(to_ns(take->all.stamps[r]));
      const Vec3 hand = m * (wander(2, t) - wander(0, t)) + wander(0, t);
      CHECK((at(rows(*take, 1), r, 2) - hand).norm() < 5e-3);  // the flat ends of the splines
    }
  }
}

TEST_CASE("a given transform is applied as it is") {
  Manifest manifest;
  SpaceOptions& given = manifest.spaces["kinect"];
  given.method = "given";
  given.rotation = {std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0};  // x to -z
  given.translation = {1.0, 2.0, 3.0};
  const auto take = align(
      two(points(joints, every(30 * ms, 100), wander), points(joints, every(30 * ms, 100), wander)),
      manifest);
  REQUIRE(take);
  for (std::size_t r = 0; r < 100; ++r) {
    const Vec3 p = at(rows(*take, 0), r, 1);
    const Vec3 expected(p.z() + 1.0, p.y() + 2.0, -p.x() + 3.0);
    CHECK((at(rows(*take, 1), r, 1) - expected).norm() < 1e-12);
  }
}

TEST_CASE("the paper's table in centimetres: m = 100 and the mocap's root in metres") {
  // HFUT-MMD, equations (1) and (2) as printed: x' = m (A_rot x - A_offset), A_offset = A_rot x_k0
  // - x_d0. With m = 100 and x_d0 in metres the result is 100 times ours, in centimetres.
  const auto seen = [](std::size_t j, double t) {
    return Vec3(turn_about_y(-60.0) * wander(j, t) + Vec3(0.2, -0.9, 2.5));
  };
  Manifest manifest;
  manifest.spaces["kinect"].method = "paper";
  manifest.spaces["kinect"].onto_root = "SpineBase";
  const auto reference = points(joints, every(10 * ms, 300), wander);
  const auto kinect = points(joints, every(10 * ms, 300), seen);
  const auto take = align(two(reference, kinect), manifest);
  REQUIRE(take);
  for (std::size_t r = 0; r < 300; ++r) {
    const auto x = [&](std::size_t j) { return vec3(kinect.frames.positions, 4 * r + j); };
    const Vec3 x_d0 = vec3(reference.frames.positions, 4 * r);
    const Vec3 offset = turn_about_y(60.0) * x(0) - x_d0;
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3 printed = 100.0 * (turn_about_y(60.0) * x(j) - offset);
      CHECK((100.0 * at(rows(*take, 1), r, j) - printed).norm() < 1e-10);
    }
  }
}

TEST_CASE("a stream without a space says so, and names its space") {
  const auto stream = points(joints, every(10 * ms, 300), wander);
  Manifest manifest;
  const auto take = align(two(stream, stream), manifest);
  REQUIRE(take);
  CHECK(take->header.groups[0].space == "take");
  CHECK(take->header.groups[1].space == "kinect");
  REQUIRE(take->report.findings.size() == 1);
  CHECK(take->report.findings[0].severity == Severity::note);
  CHECK(to_string(take->report.findings[0].what) ==
        "expected a space for 'kinect', found no [space.kinect]");

  manifest.spaces["kinect"].method = "none";
  CHECK(align(two(stream, stream), manifest)->report.findings.empty());
  manifest.spaces["kinect"].method = "fit";
  const auto moved = align(two(stream, stream), manifest);
  CHECK(moved->report.findings.empty());
  CHECK(moved->header.groups[1].space == "take");
}

TEST_CASE("a fit of what is not the same motion is a warning") {
  const auto other = [](std::size_t j, double t) { return Vec3(2.0 * wander(3 - j, 3.0 * t)); };
  Manifest manifest;
  manifest.spaces["kinect"].method = "fit";
  const auto take = align(
      two(points(joints, every(10 * ms, 300), wander), points(joints, every(10 * ms, 300), other)),
      manifest);
  REQUIRE(take);
  REQUIRE(take->report.findings.size() == 1);
  CHECK(take->report.findings[0].severity == Severity::warning);
  CHECK(take->report.spaces[0].after_m > 0.3);
}
