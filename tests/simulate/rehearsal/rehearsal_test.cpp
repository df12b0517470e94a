// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include "tests/seeds.h"

#include "kinalign/motion/kinect_map.h"
#include "kinalign/simulate/person/built_in_motion.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

const Time zero = utc_time(1'790'000'000'000'000'000);

Motion person(std::uint64_t seed, double length_s) {
  auto motion = built_in_motion({.length_s = length_s, .seed = seed});
  REQUIRE(motion);
  return *std::move(motion);
}

Rehearsal rehearsed(const Motion& motion, std::uint64_t seed) {
  auto done = rehearse(motion, {.seed = seed, .node_rate_hz = 100});
  REQUIRE_MESSAGE(done, (done ? "" : to_string(done.error())));
  return *std::move(done);
}

double ms_off(const TrueClock& clock, Time stamp, double true_s) {
  return 1e3 * std::abs(seconds(true_time(clock, stamp).value() - time_at(zero, true_s)));
}

}  // namespace

TEST_CASE("a suit's frames begin some 53 ms behind the click, and end behind the other one") {
  for (const auto seed : fresh_seeds(1)) {
    CAPTURE(seed);
    const Motion motion = person(1, 4.0);
    double sum = 0.0;
    constexpr std::uint64_t takes = 8;
    for (std::uint64_t i = 0; i < takes; ++i) {
      const MocapRun run = rehearsed(motion, seed + i).mocap;
      CHECK(run.start_click_s == 0.5);
      CHECK(run.stop_click_s == 3.5);
      const double latency = run.first_frame_s - run.start_click_s;
      CHECK(latency > 0.010);  // 6 sigma
      CHECK(latency < 0.098);
      sum += latency;
      const double last = run.frame_s(run.frames - 1);
      CHECK(last < 4.0);
      CHECK(last - run.stop_click_s > 0.0);
    }
    CHECK(std::abs(sum / takes - click_latency_s) < 0.015);  // 5 sigma of a mean of 8
  }
}

TEST_CASE("frames of the suit are the motion, at the times that the truth has") {
  const Motion motion = person(3, 4.0);
  const Rehearsal done = rehearsed(motion, 3);
  const ClipFrames frames = mocap_frames(motion, done.mocap, 0, done.mocap.frames, zero);
  const TrueRecording truth = truth_of(done, motion, zero);
  REQUIRE(frames.size() == truth.mocap.frames);
  Pose pose;
  for (std::size_t k = 0; k < frames.size(); k += 37) {
    CHECK(std::abs(to_ns(frames.stamps[k]) - truth.mocap.frame_ns(k)) <= 1);
    motion.pose_at(seconds(frames.stamps[k] - zero), pose);
    const std::size_t hips = k * motion.skeleton.joints();
    CHECK((pose.local_positions[0] - vec3(frames.local_positions, hips)).norm() < 1e-7);
    CHECK(pose.local_rotations[0].angularDistance(quat(frames.local_rotations, hips)) < 1e-7);
  }
}

TEST_CASE("the camera stands before the person, about level, and sees them all the time") {
  for (const auto seed : fresh_seeds(2)) {
    CAPTURE(seed);
    const Motion motion = person(seed, 4.0);
    const Rehearsal done = rehearsed(motion, seed);
    const RigidTransform& camera = done.camera.world_from_kinect;
    CHECK((camera.rotation * Vec3::UnitY()).y() > std::cos(0.08));
    CHECK(camera.translation.y() > 0.89);
    CHECK(camera.translation.y() < 1.21);
    CHECK(camera.translation.z() > 2.0);  // the built-in person faces +z at first
    std::size_t tracked = 0;
    for (const Tracking state : done.kinect.state) tracked += state == Tracking::tracked ? 1 : 0;
    CHECK(tracked > done.kinect.state.size() / 2);
    // The person's left is at smaller x, as in the SDK.
    CHECK(done.kinect.positions[3 * shoulder_left] < done.kinect.positions[3 * shoulder_right]);
  }
}

TEST_CASE("the truth of a clock gives the true time of every stamp in its file") {
  for (const auto seed : fresh_seeds(2)) {
    CAPTURE(seed);
    const Motion motion = person(seed, 5.0);
    const Rehearsal done = rehearsed(motion, seed);
    const TrueRecording truth = truth_of(done, motion, zero);
    const PointStream kinect = kinect_file(done, zero);
    for (std::size_t i = 0; i < done.ticks.size(); ++i) {
      CHECK(ms_off(truth.kinect.clock, kinect.frames.stamps[i], done.ticks[i].seconds) < 1e-3);
    }
    REQUIRE(truth.nodes.size() == 5);
    for (std::size_t n = 0; n < 5; ++n) {
      const SimulatedNode& node = done.nodes[n];
      const ImuStream file = node_file(node, zero);
      double worst = 0.0, worst_stamp = 0.0;
      for (std::size_t i = 0; i < node.samples.size(); ++i) {
        const Time stamp = file.samples.stamps[i];
        worst = std::max(worst, ms_off(truth.nodes[n].clock, stamp, node.truth.times[i]));
        worst_stamp =
            std::max(worst_stamp, std::abs(seconds(stamp - time_at(zero, node.truth.times[i]))));
      }
      CHECK(worst < 1e-3);
      CHECK(worst_stamp < most_drift * motion.length_s + 1e-5);
    }
  }
}

TEST_CASE("samples stamped by their arrival are the node's, later by the radio's delay") {
  const Motion motion = person(5, 4.0);
  const Rehearsal done = rehearsed(motion, 5);
  const SimulatedNode& node = done.nodes[1];
  const ArrivedNode arrived = arrived_node(node, Link::paper, zero);
  const ImuSamples& samples = arrived.stream.samples;
  REQUIRE(samples.size() > node.samples.size() * 9 / 10);
  REQUIRE(samples.size() <= node.samples.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Time truth = utc_time(arrived.clock.times_ns[k]);
    CHECK(to_ns(samples.stamps[k]) == arrived.clock.stamps_ns[k]);
    const double delay = seconds(samples.stamps[k] - truth);
    CHECK(delay > 0.0034);
    sum += delay;
    const auto at = std::lower_bound(node.truth.times.begin(), node.truth.times.end(),
                                     seconds(truth - zero) - 1e-6);
    REQUIRE(at != node.truth.times.end());
    const auto i = static_cast<std::size_t>(at - node.truth.times.begin());
    CHECK(samples.acceleration[3 * k] ==
          static_cast<double>(node.samples[i].sample.acceleration[0]));
  }
  // They wait in a queue, so no less than for one alone.
  CHECK(sum / static_cast<double>(samples.size()) > 0.033);
}

TEST_CASE("a motion that is too short, or of no body that we know, is refused") {
  const auto short_one = rehearse(person(1, 2.0), {});
  REQUIRE(!short_one);
  CHECK(short_one.error().expected == "a motion of at least 3 s");
  Motion stick;
  stick.length_s = 10.0;
  stick.skeleton = {{"Root"}, {-1}, {Vec3::Zero()}, {}};
  stick.pose_at = [](double, Pose& pose) {
    pose.local_positions = {Vec3::Zero()};
    pose.local_rotations = {Quat::Identity()};
  };
  CHECK(!rehearse(stick, {}));
}

TEST_CASE("a node over a link that loses has its own stamps, and gaps") {
  const Motion motion = person(3, 6.0);
  const Rehearsal done = rehearsed(motion, 2);
  for (const SimulatedNode& node : done.nodes) {
    const ImuSamples all = node_file(node, zero).samples;
    const ImuSamples received = received_node(node, Link::paper, zero).samples;
    const double share =
        static_cast<double>(received.stamps.size()) / static_cast<double>(all.stamps.size());
    CHECK(share > 0.85);
    CHECK(share < 1.0);
    std::size_t i = 0;
    for (std::size_t k = 0; k < received.stamps.size(); ++k, ++i) {
      while (i < all.stamps.size() && all.stamps[i] != received.stamps[k]) ++i;
      REQUIRE(i < all.stamps.size());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(received.angular_velocity[3 * k + axis] == all.angular_velocity[3 * i + axis]);
      }
    }
  }
}

TEST_CASE("the camera errs on a person as it does, whatever the seed of the take") {
  const Motion motion = person(3, 4.0);
  const auto of = [&](std::uint64_t seed, std::optional<std::uint64_t> who) {
    auto done = rehearse(motion, {.seed = seed, .person = who});
    REQUIRE(done);
    return done->kinect.positions;
  };
  CHECK(of(2, {}) == of(2, 2));
  CHECK(of(2, 9) != of(2, 2));
}
