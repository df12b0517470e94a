// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/nodes/inertial_nodes.h"

#include "tests/about.h"
#include "tests/motion/rotations.h"
#include "tests/seeds.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/simulate/person/built_in_motion.h"
#include "kinalign/simulate/person/perception_neuron.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

using namespace kinalign;

namespace {

InertialSensorModel perfect() {
  InertialSensorModel model;
  model.gyroscope_noise = model.gyroscope_walk = model.gyroscope_zero = model.gyroscope_scale = 0.0;
  model.accelerometer_noise = model.accelerometer_walk = model.accelerometer_zero = 0.0;
  model.accelerometer_scale = model.misalignment = 0.0;
  return model;
}

Motion person(const Programme& programme, std::uint64_t seed = 1) {
  auto motion = built_in_motion({.programme = programme, .seed = seed});
  REQUIRE(motion);
  return *std::move(motion);
}

std::vector<SimulatedNode> nodes_on(const Motion& motion, const InertialNodeOptions& options,
                                    std::uint64_t seed = 1) {
  const auto mountings = five_nodes(motion.skeleton, seed);
  REQUIRE(mountings);
  auto nodes = simulate_nodes(motion, *mountings, options, seed);
  REQUIRE(nodes);
  return *std::move(nodes);
}

Quat orientation_of(const NodeSample& sample) {
  const auto& q = sample.orientation;
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}

Vec3 vec(const std::array<float, 3>& x) { return {x[0], x[1], x[2]}; }

/// The angle between the estimated and the true up, rad.
double tilt_error(const Quat& estimate, const Quat& truth) {
  const Vec3 seen = estimate.conjugate() * Vec3::UnitY(), is = truth.conjugate() * Vec3::UnitY();
  return std::atan2(seen.cross(is).norm(), seen.dot(is));
}

/// The angle between a node's heading and the world's, rad, which is constant but for drift.
double heading_off(const SimulatedNode& node, std::size_t i) {
  const Quat estimate = orientation_of(node.samples[i].sample);
  return heading_of(estimate * node.truth.places[i].world_from_sensor.conjugate());
}

}  // namespace

TEST_CASE("five nodes sit where the paper's people wear them, a little otherwise each time") {
  const Skeleton skeleton = perception_neuron(1.75, 0);
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    const auto found = five_nodes(skeleton, seed);
    REQUIRE(found);
    const auto& nodes = *found;
    REQUIRE(nodes.size() == 5);
    CHECK(nodes[0].node_name == "waist");
    CHECK(nodes[0].joint == index(NeuronJoint::hips));
    CHECK((nodes[0].offset - Vec3(0, 0.05, -0.10)).cwiseAbs().maxCoeff() < 0.011);
    CHECK(nodes[1].node_name == "wrist_left");
    CHECK(nodes[1].joint == index(NeuronJoint::left_fore_arm));
    CHECK(std::abs(nodes[1].offset.x() - (0.26 - 0.04)) < 0.021);  // 3 to 5 cm from the wrist
    CHECK(std::abs(nodes[1].offset.y() - 0.03) < 0.011);           // on the back of the forearm
    CHECK(nodes[2].offset.x() < 0.0);
    CHECK(nodes[4].node_name == "ankle_right");
    CHECK(nodes[4].joint == index(NeuronJoint::right_leg));
    CHECK(nodes[4].offset.y() < -0.08);
    CHECK(nodes[4].offset.y() > -0.22);
    CHECK(nodes[4].offset.z() > 0.02);  // in front …
    CHECK(nodes[4].offset.x() < 0.0);   // … and outside
    // z of the waist's sensor points backwards, to within 15 degrees.
    CHECK(std::acos((nodes[0].bone_from_sensor * Vec3::UnitZ()).dot(-Vec3::UnitZ())) < 0.27);
  }
  const auto one = five_nodes(skeleton, 1), two = five_nodes(skeleton, 2);
  CHECK((one->front().offset - two->front().offset).norm() > 1e-4);
}

TEST_CASE("a skeleton without a shank can't wear a node on it") {
  Skeleton skeleton = perception_neuron(1.75, 0);
  skeleton.joint_names[index(NeuronJoint::right_leg)] = "Bein";
  const auto nodes = five_nodes(skeleton, 1);
  REQUIRE_FALSE(nodes);
  CHECK(to_string(nodes.error()) ==
        "expected a skeleton with a joint RightLeg to wear a node on, found no such joint");
}

TEST_CASE("samples come at the node's rate, and their stamps name when they were taken") {
  const Motion motion = person({{Piece::t_pose, 4.0}, {Piece::walk, 6.0}});
  for (const std::uint32_t rate : {15U, 60U, 100U}) {
    CAPTURE(rate);
    const auto nodes = nodes_on(motion, {.rate_hz = rate});
    for (const SimulatedNode& node : nodes) {
      CHECK(std::abs(static_cast<double>(node.samples.size()) - 10.0 * rate) < 1.5);
      REQUIRE(node.truth.times.size() == node.samples.size());
      const SimulatedClock clock(node.seed, motion.length_s);
      for (std::size_t i = 0; i < node.samples.size(); ++i) {
        const double counter = clock.reading(node.truth.times[i]) * 1e6;
        CHECK(std::abs(counter - static_cast<double>(node.samples[i].counter_us)) < 1e-3);
        if (i == 0) continue;
        const auto step = static_cast<std::int64_t>(node.samples[i].counter_us) -
                          static_cast<std::int64_t>(node.samples[i - 1].counter_us);
        CHECK(std::abs(step - 1'000'000 / static_cast<std::int64_t>(rate)) < 400);
      }
    }
    // Each node has a clock of its own.
    CHECK(nodes[0].samples[5].counter_us != nodes[1].samples[5].counter_us);
  }
}

TEST_CASE("the truth of a sample is the motion at its time") {
  const Motion motion = person({{Piece::walk, 8.0}});
  const auto nodes = nodes_on(motion, {.rate_hz = 15});
  Pose pose;
  GlobalPose global;
  for (const SimulatedNode& node : nodes) {
    for (std::size_t i = 0; i < node.samples.size(); i += 7) {
      motion.pose_at(node.truth.times[i], pose);
      forward_kinematics(motion.skeleton, pose, global);
      const SensorPlace place = place_of(node.mounting, global);
      CHECK((place.position - node.truth.places[i].position).norm() == 0.0);
      CHECK(angle_between(place.world_from_sensor, node.truth.places[i].world_from_sensor) == 0.0);
    }
  }
}

TEST_CASE(
    "without a chip's faults a sample is what moved, as late as the filter and the registers") {
  const Motion motion = person({{Piece::t_pose, 2.0}, {Piece::walk, 8.0}});
  const auto nodes = nodes_on(motion, {.rate_hz = 100, .sensor = perfect()});
  Pose pose;
  for (const SimulatedNode& node : nodes) {
    // The mean delay with which the truth explains the rates best, by least squares over a grid.
    const auto miss = [&](double delay) {
      double sum = 0.0;
      for (std::size_t i = 20; i < node.samples.size(); ++i) {
        std::array<SensorPlace, 5> places;
        GlobalPose global;
        for (std::size_t k = 0; k < 5; ++k) {
          motion.pose_at(node.truth.times[i] - delay + 1e-3 * (static_cast<double>(k) - 2.0), pose);
          forward_kinematics(motion.skeleton, pose, global);
          places[k] = place_of(node.mounting, global);
        }
        const InertialReading truth = true_reading(places, 1e-3);
        sum +=
            (truth.angular_velocity - vec(node.samples[i].sample.angular_velocity)).squaredNorm();
      }
      return std::sqrt(sum / static_cast<double>(node.samples.size() - 20));
    };
    // 5.0 ms of the filter at 41 Hz, and half a millisecond for the age of the registers.
    CHECK(miss(0.0055) < 0.04);  // rad/s rms
    CHECK(miss(0.0055) < miss(0.0035));
    CHECK(miss(0.0055) < miss(0.0075));
    CHECK(miss(0.0055) < 0.5 * miss(0.0));
  }
}

TEST_CASE("a node on a body that stands reads gravity, and its orientation keeps the true up") {
  const Motion still{perception_neuron(1.75, 0), 5.0, [](double, Pose& pose) {
                       const Skeleton skeleton = perception_neuron(1.75, 0);
                       pose.local_positions = skeleton.rest_offsets;
                       pose.local_rotations.assign(skeleton.joints(), Quat::Identity());
                     }};
  for (const SimulatedNode& node : nodes_on(still, {.rate_hz = 15, .sensor = perfect()})) {
    for (std::size_t i = 0; i < node.samples.size(); ++i) {
      const NodeSample& sample = node.samples[i].sample;
      const Quat& truth = node.truth.places[i].world_from_sensor;
      CHECK((truth * vec(sample.acceleration) - Vec3(0, 9.80665, 0)).norm() < 0.01);
      CHECK(vec(sample.angular_velocity).norm() < 1e-9);
      CHECK(tilt_error(orientation_of(sample), truth) < 0.001);
      CHECK(sample.gravity_included);
    }
    CHECK(std::abs(heading_of(orientation_of(node.samples.front().sample))) < 1e-9);
  }
}

TEST_CASE("orientation tilts and drifts on a walk, as much as the page states") {
  double tilt_square = 0.0, worst_drift = 0.0, worst_tilt = 0.0;
  std::size_t count = 0;
  for (const std::uint64_t seed : {1U, 2U}) {
    const Motion motion = person({{Piece::t_pose, 4.0}, {Piece::walk_turn, 56.0}}, seed);
    for (const SimulatedNode& node : nodes_on(motion, {.rate_hz = 60}, seed)) {
      for (std::size_t i = 0; i < node.samples.size(); ++i) {
        const double tilt = tilt_error(orientation_of(node.samples[i].sample),
                                       node.truth.places[i].world_from_sensor);
        tilt_square += tilt * tilt;
        worst_tilt = std::max(worst_tilt, tilt);
        ++count;
      }
      const double drift = heading_off(node, node.samples.size() - 1) - heading_off(node, 60);
      worst_drift = std::max(worst_drift, std::abs(std::remainder(drift, 2 * std::numbers::pi)));
    }
  }
  const double rms = std::sqrt(tilt_square / static_cast<double>(count)) * 180 / std::numbers::pi;
  MESSAGE("tilt " << rms << " deg rms, " << worst_tilt * 180 / std::numbers::pi
                  << " at worst; heading " << worst_drift * 180 / std::numbers::pi
                  << " deg a minute at worst");
  CHECK(rms > 0.7);  // a node that does better is fed the truth
  CHECK(rms < 2.5);
  CHECK(worst_drift * 180 / std::numbers::pi > 0.5);
  CHECK(worst_drift * 180 / std::numbers::pi < 12.0);
}

TEST_CASE("a node that was not calibrated at rest drifts by its whole zero") {
  const Motion motion = person({{Piece::stand, 20.0}});
  InertialNodeOptions options{.rate_hz = 15, .rest_s = 0.0};
  options.sensor = perfect();
  options.sensor.gyroscope_zero = 0.01745;
  options.filter.bias_gain = 0.0;
  for (const SimulatedNode& node : nodes_on(motion, options)) {
    const Quat& truth = node.truth.places.back().world_from_sensor;
    const double about_up = (truth * node.errors.gyroscope_zero).y();
    const double time = node.truth.times.back() - node.truth.times[15];
    const double drift = heading_off(node, node.samples.size() - 1) - heading_off(node, 15);
    CHECK(std::abs(drift - about_up * time) < 0.03);
  }
}

TEST_CASE("what a zero walks between the rest and the beginning shows as drift") {
  const Motion motion = person({{Piece::stand, 15.0}});
  const auto drift = [&](double worn_s) {
    InertialNodeOptions options{.rate_hz = 15, .worn_s = worn_s, .sensor = perfect()};
    options.sensor.gyroscope_walk = 2e-4;
    double square = 0.0;
    for (const SimulatedNode& node : nodes_on(motion, options)) {
      const double off = heading_off(node, node.samples.size() - 1) - heading_off(node, 15);
      square += off * off / 5.0;
    }
    return std::sqrt(square);
  };
  // 2e-4 sqrt(1000) rad/s for 14 s are 0.09 rad; within 15 s it walks by a tenth of that.
  CHECK(drift(1000.0) > 0.03);
  CHECK(drift(1000.0) < 0.25);
  CHECK(drift(0.0) < 0.02);
}

TEST_CASE("a node whose firmware runs no filter sends no orientation") {
  const Motion motion = person({{Piece::stand, 2.0}});
  for (const SimulatedNode& node : nodes_on(motion, {.rate_hz = 60, .orientation = false})) {
    for (const auto& taken : node.samples) CHECK_FALSE(taken.sample.has_orientation);
    CHECK_FALSE(imu_stream(node, Time{}).content.orientation);
    CHECK(imu_stream(node, Time{}).samples.orientation.empty());
  }
}

TEST_CASE("a stream for files holds the same samples, stamped by the node's counter") {
  const Motion motion = person({{Piece::wave, 4.0}});
  const SimulatedNode node = nodes_on(motion, {.rate_hz = 60}).at(2);
  const ImuStream stream = imu_stream(node, utc_time(1'700'000'000'000'000'000));
  CHECK(stream.node_names == std::vector<std::string>{"wrist_right"});
  CHECK(stream.content == ImuContent{true, true, true, true});
  const ImuSamples& samples = stream.samples;
  REQUIRE(samples.size() == node.samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [counter, sample] = node.samples[i];
    CHECK(to_ns(samples.stamps[i]) ==
          1'700'000'000'000'000'000 + 1000 * static_cast<std::int64_t>(counter));
    CHECK(samples.acceleration[3 * i + 2] == static_cast<double>(sample.acceleration[2]));
    CHECK(samples.angular_velocity[3 * i] == static_cast<double>(sample.angular_velocity[0]));
    CHECK(samples.orientation[4 * i] == static_cast<double>(sample.orientation[0]));
    CHECK(samples.valid[i] == 1);
  }
}

TEST_CASE("the same seed gives the same samples, another one others") {
  const Motion motion = person({{Piece::walk, 4.0}});
  const auto one = nodes_on(motion, {}, 5), again = nodes_on(motion, {}, 5);
  const auto other = nodes_on(motion, {}, 6);
  for (std::size_t n = 0; n < 5; ++n) {
    REQUIRE(one[n].samples.size() == again[n].samples.size());
    for (std::size_t i = 0; i < one[n].samples.size(); ++i) {
      CHECK(one[n].samples[i].counter_us == again[n].samples[i].counter_us);
      CHECK(one[n].samples[i].sample == again[n].samples[i].sample);
    }
    CHECK_FALSE(one[n].samples[3].sample == other[n].samples[3].sample);
  }
}

TEST_CASE("a rate of zero, and a mounting outside the skeleton, are refused") {
  const Motion motion = person({{Piece::stand, 1.0}});
  const auto message = [&](const std::vector<Mounting>& mountings, std::uint32_t rate) {
    const auto nodes = simulate_nodes(motion, mountings, {.rate_hz = rate}, 1);
    REQUIRE_FALSE(nodes);
    return to_string(nodes.error());
  };
  CHECK(message({}, 0) == "expected a rate of 1 to 1000 Hz, found 0 Hz");
  CHECK(message({}, 1001) == "expected a rate of 1 to 1000 Hz, found 1001 Hz");
  CHECK(message({Mounting{"hat", 99, Vec3::Zero(), Quat::Identity()}}, 60) ==
        "expected a joint of the skeleton for node hat, found joint 99");
}
