// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/rehearsal/judge_recording.h"

#include "tests/take/recorded.h"

#include "kinalign/motion/kinect_map.h"
#include "kinalign/simulate/person/built_in_motion.h"
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

const Time zero = utc_time(1'790'000'000'000'000'000);

/// A rehearsal of 4 s as a recording in memory; its clocks are used as they are.
struct Rehearsed {
  Motion motion = *built_in_motion({.length_s = 4.0, .seed = 2});
  Rehearsal rehearsal = *rehearse(motion, {.seed = 2, .node_rate_hz = 100});
  TrueRecording truth = truth_of(rehearsal, motion, zero);
  Recording recording;

  Rehearsed() {
    const MocapRun& run = rehearsal.mocap;
    Clip clip{motion.skeleton, mocap_frames(motion, run, 0, run.frames, zero)};
    recording.streams.push_back(recorded("mocap", std::move(clip)));
    recording.streams.push_back(recorded("kinect", kinect_file(rehearsal, zero)));
    for (const SimulatedNode& node : rehearsal.nodes) {
      recording.streams.push_back(recorded("imu", node_file(node, zero)));
    }
  }
};

/// Rows of the true points of a Kinect, 20 ms apart, each `off` away from the truth.
Take true_points(const Rehearsed& all, const Vec3& off) {
  const KinectMap map = *kinect_map(all.motion.skeleton);
  Take take;
  take.header.groups.resize(1);
  take.header.groups[0].name = "kinect";
  take.header.groups[0].kind = PointGroup{};
  PointRows rows;
  Pose pose;
  GlobalPose global;
  for (Time t = zero + 500ms; t < zero + 1500ms; t += 20ms) {
    take.all.stamps.push_back(t);
    all.motion.pose_at(seconds(t - zero), pose);
    forward_kinematics(all.motion.skeleton, pose, global);
    rows.positions.resize(75 * take.all.stamps.size());
    kinect_positions(map, global, std::span(rows.positions).last(75));
    for (std::size_t i = rows.positions.size() / 3 - 25; i < rows.positions.size() / 3; ++i) {
      vec3(rows.positions, i) += off;
    }
  }
  rows.valid.assign(rows.positions.size() / 3, 1);
  take.all.rows.emplace_back(std::move(rows));
  return take;
}

}  // namespace

TEST_CASE("stamps that the files have are as far from the truth as their crystals") {
  const Rehearsed all;
  for (const RecordedStream& stream : all.recording.streams) {
    CAPTURE(stream.name);
    const auto judged = judge_time(stream, all.truth, {});
    REQUIRE_MESSAGE(judged, (judged ? "" : to_string(judged.error())));
    CHECK(judged->samples > 100);
    CHECK(judged->worst_s <= most_drift * 4.0 + 1e-6);
    CHECK(judged->median_s <= judged->most_s);
    CHECK(judged->most_s <= judged->worst_s);
    CHECK(!judged->half_width_s);
    CHECK(judged->certified == 0);
  }
}

TEST_CASE("a clock that is 3 ms off is found so, and outside what it states") {
  Rehearsed all;
  RecordedStream& waist = all.recording.streams[2];
  waist.clock.pieces.front().offset = 3ms;
  waist.clock.pieces.front().half_width = 2ms;
  auto judged = judge_time(waist, all.truth, {});
  REQUIRE(judged);
  CHECK(judged->node == "waist");
  CHECK(judged->median_s == doctest::Approx(0.003).epsilon(0.05));
  CHECK(judged->half_width_s == 0.002);
  CHECK(judged->certified == judged->samples);
  CHECK(judged->outside == judged->samples);
  judged = judge_time(waist, all.truth, 3ms);  // the recording's UTC is late by as much
  CHECK(judged->outside == 0);
  CHECK(judged->worst_s < 1e-4);
}

TEST_CASE("a node is known by its number, too; an unknown node is refused") {
  Rehearsed all;
  RecordedStream& waist = all.recording.streams[2];
  std::get<ImuInput>(waist.data).node_names = {"1"};
  CHECK(judge_time(waist, all.truth, {})->worst_s < 1e-3);
  std::get<ImuInput>(waist.data).node_names = {"hat"};
  const auto judged = judge_time(waist, all.truth, {});
  REQUIRE(!judged);
  CHECK(judged.error().found == "imu hat");
}

TEST_CASE("an unknown device is refused with the devices of the truth") {
  Rehearsed all;
  all.recording.streams[0].name = "suit";
  const auto judged = judge_time(all.recording.streams[0], all.truth, {});
  REQUIRE(!judged);
  CHECK(to_string(judged.error()) ==
        "expected a device that the truth has (mocap, kinect, imu waist, imu wrist_left, imu "
        "wrist_right, imu ankle_left, imu ankle_right), found suit");
}

TEST_CASE("true points have no error, points 1 cm away have 1 cm") {
  const Rehearsed all;
  for (const double off : {0.0, 0.01}) {
    const Take take = true_points(all, Vec3(0, off, 0));
    const auto values = judge_values({take, all.recording, all.truth, all.motion});
    REQUIRE(values);
    REQUIRE(values->size() == 1);
    const ValueJudgement& kinect = values->front();
    CHECK(kinect.count == 50 * 25);
    CHECK(kinect.after == doctest::Approx(off).epsilon(1e-9));
    CHECK(kinect.before.value() > 1.0);  // camera space
    CHECK(kinect.alone.value() > 0.02);  // docs/kinect_noise.md: 5 to 10 cm
    CHECK(kinect.alone.value() < 0.2);
  }
}

TEST_CASE("nodes together are off by the root of their mean square, by rows") {
  const ValueJudgement all =
      together(std::array{ValueJudgement{"imu", "waist", 300, std::nullopt, 1.0, 0.5},
                          ValueJudgement{"imu", "head", 100, std::nullopt, 3.0, 0.5}});
  CHECK(all.node == "all nodes");
  CHECK(all.count == 400);
  CHECK(all.after == doctest::Approx(std::sqrt(3.0)));  // (3 * 1 + 9) / 4
  CHECK(all.alone.value() == doctest::Approx(0.5));
}
