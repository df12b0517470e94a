// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/xsens_pose.h"

#include "tests/protocols/xsens/xsens_cases.h"
#include "tests/seeds.h"

#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace kinalign;

namespace {

XsensPose pose_of(const XsensSample& sample) { return std::get<XsensPose>(sample.body); }
XsensTrackers trackers_of(const XsensSample& sample) {
  return std::get<XsensTrackers>(sample.body);
}

/// 90 degrees about the stream's up axis z: from x to y.
constexpr std::array<float, 4> left_turn{0.70710678F, 0, 0, 0.70710678F};

}  // namespace

TEST_CASE("xsens pose: z up becomes y up, and a segment at rest has no rotation") {
  XsensPoser poser("mvn");
  CHECK(poser.skeleton() == nullptr);
  ClipFrames frames;
  auto pose = pose_of(xsens_pose());
  pose.segments[0].position = {1.0F, 2.0F, 0.9375F};
  REQUIRE(poser.append(pose, utc_time(5), frames));
  CHECK(frames.stamps == std::vector{utc_time(5)});
  CHECK(vec3(frames.local_positions, 0) == Vec3(1.0, 0.9375, -2.0));
  for (std::size_t k = 0; k < 23; ++k) {
    CHECK(quat(frames.local_rotations, k).angularDistance(Quat::Identity()) < 1e-12);
  }
  REQUIRE(poser.skeleton() != nullptr);
  CHECK(validate(*poser.skeleton()));
  CHECK(poser.skeleton()->joint_names[22] == "LeftToe");
  CHECK(poser.skeleton()->parents[19] == 0);
}

TEST_CASE("xsens pose: a turn about the stream's up is one about ours") {
  XsensPoser poser("mvn");
  ClipFrames frames;
  auto pose = pose_of(xsens_pose());
  for (auto& segment : pose.segments) segment.rotation = left_turn;
  REQUIRE(poser.append(pose, utc_time(0), frames));
  const Quat about_y(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));
  CHECK(quat(frames.local_rotations, 0).angularDistance(about_y) < 1e-6);
  // L5 is 0.0625 along the stream's x: to the right of a pelvis that was turned left.
  CHECK((vec3(frames.local_positions, 1) - Vec3(0.0, 0.0, 0.0625)).norm() < 1e-6);
}

TEST_CASE("xsens pose: forward kinematics gives back the global places and rotations") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    XsensPose pose = pose_of(xsens_pose());
    for (auto& s : pose.segments) {
      const Quat q =
          Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
      s.rotation = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
                    static_cast<float>(q.z())};
      for (float& x : s.position) x += 0.1F * static_cast<float>(normal(random));
    }
    XsensPoser poser("mvn");
    ClipFrames frames;
    REQUIRE(poser.append(pose, utc_time(0), frames));
    std::vector<double> global(23 * 3);
    forward_kinematics(*poser.skeleton(), frames, global);
    for (std::size_t k = 0; k < 23; ++k) {
      const auto& p = pose.segments[k].position;
      CHECK((vec3(global, k) - Vec3(p[0], p[2], -p[1])).norm() < 1e-9);
    }
  }
}

TEST_CASE("xsens pose: metres or centimetres by the height of the pelvis, and it is said") {
  for (const bool centimetres : {false, true}) {
    auto pose = pose_of(xsens_pose());
    if (centimetres) {
      for (auto& s : pose.segments) {
        for (float& x : s.position) x *= 100.0F;
      }
    }
    XsensPoser poser("mvn");
    ClipFrames frames;
    REQUIRE(poser.append(pose, utc_time(0), frames));
    CHECK(frames.local_positions[1] == doctest::Approx(0.9375));
    REQUIRE(poser.findings.size() == 1);
    CHECK(to_string(poser.findings[0].what) ==
          (centimetres
               ? "mvn: expected a unit of length, which the stream does not state, found a pelvis "
                 "93.8 above the lowest segment"
               : "mvn: expected a unit of length, which the stream does not state, found a pelvis "
                 "0.938 above the lowest segment"));
    CHECK(poser.findings[0].meaning ==
          (centimetres ? "lengths are read as centimetres" : "lengths are read as metres"));
  }
}

TEST_CASE("xsens pose: who lies is measured by length, and the unit stays") {
  for (const float scale : {1.0F, 100.0F}) {
    auto pose = pose_of(xsens_pose());
    for (auto& s : pose.segments) s.position = {s.position[0] * scale, 0, 0.05F * scale};
    XsensPoser poser("mvn");
    ClipFrames frames;
    REQUIRE(poser.append(pose, utc_time(0), frames));
    CHECK(frames.local_positions[1] == doctest::Approx(0.05));
    REQUIRE(poser.append(pose_of(xsens_pose()), utc_time(1), frames));
    CHECK(poser.findings.size() == 1);
    CHECK(frames.local_positions[3 * 23 + 1] == doctest::Approx(0.9375 / scale));
  }
}

TEST_CASE("xsens pose: props and fingers behind the body are left out, whatever their ids") {
  auto pose = pose_of(xsens_pose(30));
  pose.segments[24].id = 3;
  XsensPoser poser("mvn");
  ClipFrames frames;
  REQUIRE(poser.append(pose, utc_time(0), frames));
  CHECK(frames.local_positions.size() == 23 * 3);
}

TEST_CASE("xsens pose: what is no whole pose of numbers is refused and leaves nothing") {
  XsensPoser poser("mvn");
  ClipFrames frames;
  auto refused = [&](const XsensPose& pose) {
    const auto result = poser.append(pose, utc_time(0), frames);
    REQUIRE(!result);
    return to_string(result.error());
  };
  CHECK(refused(pose_of(xsens_pose(22))) == "mvn: expected 23 segments in a pose, found 22");
  auto pose = pose_of(xsens_pose());
  pose.segments[4].id = 4;
  CHECK(
      refused(pose) ==
      "mvn: expected the segments 1 to 23, each once, first in a pose, found segment 4 as item 5");
  pose = pose_of(xsens_pose());
  pose.segments[4].rotation = {0, 0, 0, 0};
  CHECK(refused(pose) ==
        "mvn: expected a finite position and a unit quaternion, found other values for T8");
  pose = pose_of(xsens_pose());
  pose.segments[6].position[1] = NAN;
  CHECK(refused(pose) ==
        "mvn: expected a finite position and a unit quaternion, found other values for Head");
  CHECK(frames.size() == 0);
  CHECK(poser.skeleton() == nullptr);
}

TEST_CASE("xsens nodes: items of 68 bytes give what the sensor measured") {
  XsensNodes nodes("mvn");
  ImuSamples samples;
  auto trackers = trackers_of(xsens_trackers(true));
  trackers.trackers[1].rotation = left_turn;
  REQUIRE(nodes.append(trackers, utc_time(9), samples));
  CHECK(nodes.header()->node_names == std::vector<std::string>{"Pelvis", "T8", "RightHand"});
  CHECK(nodes.header()->content == ImuContent{true, true, true, true});
  CHECK(samples.stamps == std::vector{utc_time(9)});
  CHECK(vec3(samples.acceleration, 1) == Vec3(0.5, 0.0, 9.8125));
  CHECK(vec3(samples.angular_velocity, 1) == Vec3(0.25, 0.0, 0.0));
  // The sensor's own z points up, which is our y; its x points to the stream's y, which is our -z.
  const Quat q = quat(samples.orientation, 1);
  CHECK((q * Vec3::UnitZ() - Vec3::UnitY()).norm() < 1e-6);
  CHECK((q * Vec3::UnitX() + Vec3::UnitZ()).norm() < 1e-6);
}

TEST_CASE("xsens nodes: items of 44 bytes give the free acceleration in the sensor's space") {
  XsensNodes nodes("mvn");
  ImuSamples samples;
  auto trackers = trackers_of(xsens_trackers(false));
  trackers.trackers[1].rotation = left_turn;
  REQUIRE(nodes.append(trackers, utc_time(0), samples));
  CHECK(nodes.header()->content == ImuContent{true, true, false, false});
  // The world's x is the right of a sensor turned left: its -y.
  CHECK((vec3(samples.acceleration, 1) - Vec3(0.0, -0.5, 0.0)).norm() < 1e-6);
  CHECK(samples.angular_velocity.empty());
}

TEST_CASE("xsens nodes: trackers that lack or hold no numbers are not valid, zeros stand there") {
  XsensNodes nodes("mvn");
  ImuSamples samples;
  REQUIRE(nodes.append(trackers_of(xsens_trackers(true)), utc_time(0), samples));
  auto trackers = trackers_of(xsens_trackers(true));
  trackers.trackers[0].raw->angular_velocity[2] = INFINITY;
  trackers.trackers[1].id = 20;  // the first sample did not have it
  REQUIRE(nodes.append(trackers, utc_time(1), samples));
  CHECK(samples.valid == std::vector<std::uint8_t>{1, 1, 1, 0, 0, 1});
  CHECK(vec3(samples.acceleration, 3) == Vec3::Zero());
  CHECK(samples.angular_velocity.size() == 18);
}

TEST_CASE("xsens nodes: a first sample of unknown segments and a change of kind are refused") {
  ImuSamples samples;
  auto trackers = trackers_of(xsens_trackers(true));
  trackers.trackers[2].id = 1;
  auto result = XsensNodes("mvn").append(trackers, utc_time(0), samples);
  REQUIRE(!result);
  CHECK(to_string(result.error()) ==
        "mvn: expected trackers of the segments 1 to 23, each once, found segment 1 as item 3");
  XsensNodes nodes("mvn");
  REQUIRE(nodes.append(trackers_of(xsens_trackers(true)), utc_time(0), samples));
  result = nodes.append(trackers_of(xsens_trackers(false)), utc_time(1), samples);
  REQUIRE(!result);
  CHECK(to_string(result.error()) ==
        "mvn: expected items of one size in all samples, found items of 44 and of 68 bytes");
  CHECK(samples.size() == 1);
}
