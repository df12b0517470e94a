// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 120 of the seed. Number 0 has these lanes: 0 to 3 position of
// the camera, 4 and 5 its tilt, 6 its clock. Number 1: lanes 0 and 2 the latencies of the clicks, 4
// the phase of the suit's frames.
#include "kinalign/simulate/rehearsal/rehearsal.h"

#include "kinalign/motion/kinect_joints.h"
#include "kinalign/motion/kinect_map.h"
#include "kinalign/simulate/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr double before_click_s = 0.5, behind_click_s = 0.5;
constexpr double degree = std::numbers::pi / 180.0;

// This file uses only this stream. Cameras, nodes and persons have their own streams.
RandomStream draws(std::uint64_t seed) { return {seed, 120}; }

/// The true joints for the simulated camera, at any time. The memory for poses is reused in later
/// calls.
class JointsOf {
 public:
  JointsOf(const Motion& motion, const KinectMap& map) : motion_(motion), map_(map) {}

  void operator()(double t, std::span<double> joints) {
    motion_.pose_at(t, pose_);
    forward_kinematics(motion_.skeleton, pose_, global_);
    kinect_positions(map_, global_, joints);
  }
  const GlobalPose& global() const { return global_; }

 private:
  const Motion& motion_;
  const KinectMap& map_;
  Pose pose_;
  GlobalPose global_;
};

/// Returns the height of the lowest joint or end site, m, which is taken as the floor.
double lowest_of(const Skeleton& skeleton, const GlobalPose& pose) {
  double lowest = pose.positions.front().y();
  for (const Vec3& p : pose.positions) lowest = std::min(lowest, p.y());
  for (const EndSite& end : skeleton.end_sites) {
    const auto j = static_cast<std::size_t>(end.parent);
    lowest = std::min(lowest, (pose.positions[j] + pose.rotations[j] * end.offset).y());
  }
  return lowest;
}

/// Draws the clicks, their latencies and the suit's frames.
MocapRun mocap_run(double length_s, std::uint64_t seed) {
  const RandomStream random = draws(seed);
  MocapRun run;
  const auto latency = [&](std::uint64_t lane) {
    return std::max(0.0, 0.045 + 0.006 * random.normal(1, lane));
  };
  run.start_click_s = before_click_s;
  run.stop_click_s = length_s - behind_click_s;
  // The phase is random, because a suit's frames do not depend on the clicks.
  const double step = 1.0 / run.rate_hz, phase = step * random.uniform(1, 4);
  const double from = run.start_click_s + latency(0), to = run.stop_click_s + latency(2);
  // The suit makes frames all the time. The recording begins with the first frame after the click
  // took effect.
  run.first_frame_s = phase + step * std::ceil((from - phase) / step);
  run.frames = static_cast<std::size_t>((to - run.first_frame_s) / step) + 1;
  return run;
}

/// Keeps the first pair, the last pair, and one pair per second. A crystal is steady enough between
/// them. Otherwise the truth of a long recording would contain a pair for each sample.
TrueClock thinned(const TrueClock& all) {
  TrueClock clock;
  const std::size_t count = all.stamps_ns.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool due =
        clock.stamps_ns.empty() || all.stamps_ns[i] - clock.stamps_ns.back() >= 1'000'000'000;
    if (!due && i + 1 < count) continue;
    clock.stamps_ns.push_back(all.stamps_ns[i]);
    clock.times_ns.push_back(all.times_ns[i]);
  }
  return clock;
}

/// Returns the camera's clock for the stamps of kinect_file(), which is true at the first frame.
TrueClock kinect_clock(const Rehearsal& rehearsal, Time zero) {
  TrueClock clock;
  const PointStream file = kinect_file(rehearsal, zero);
  for (std::size_t i = 0; i < rehearsal.ticks.size(); ++i) {
    clock.stamps_ns.push_back(to_ns(file.frames.stamps[i]));
    clock.times_ns.push_back(to_ns(time_at(zero, rehearsal.ticks[i].seconds)));
  }
  return thinned(clock);
}

/// Appends sample `i` of one node with another stamp.
void append_sample(const ImuSamples& all, std::size_t i, Time stamp, ImuSamples& to) {
  const auto copy = [i](const std::vector<double>& from, std::size_t width,
                        std::vector<double>& onto) {
    if (from.empty()) return;
    onto.insert(onto.end(), &from[i * width], &from[i * width] + width);
  };
  to.stamps.push_back(stamp);
  copy(all.orientation, 4, to.orientation);
  copy(all.acceleration, 3, to.acceleration);
  copy(all.angular_velocity, 3, to.angular_velocity);
  to.valid.push_back(1);
}

/// Returns the truth about a node: where it is worn, its errors, and its clock.
TrueNode true_node(const SimulatedNode& node, const Motion& motion, Time zero) {
  TrueNode truth;
  truth.stream = "imu";
  truth.node = node.mounting.node_name;
  truth.joint = motion.skeleton.joint_names[node.mounting.joint];
  truth.offset = node.mounting.offset;
  truth.bone_from_sensor = node.mounting.bone_from_sensor;
  // Delay of ChipLowPass, 0.205 / bandwidth, in ms.
  truth.sensor_delay_ms = 205.0 / InertialSensorModel{}.gyroscope_bandwidth_hz;
  truth.gyroscope_zero = node.errors.gyroscope_zero;
  truth.accelerometer_zero = node.errors.accelerometer_zero;
  // The truth refers to the stamps in a file of this node.
  const ImuStream file = node_file(node, zero);
  for (std::size_t i = 0; i < node.samples.size(); ++i) {
    truth.clock.stamps_ns.push_back(to_ns(file.samples.stamps[i]));
    truth.clock.times_ns.push_back(to_ns(time_at(zero, node.truth.times[i])));
  }
  truth.clock = thinned(truth.clock);
  return truth;
}

}  // namespace

Result<RigidTransform> camera_before(const Motion& motion, std::uint64_t seed) {
  const KinectMap map = KA_TRY(kinect_map(motion.skeleton));
  JointsOf joints_of(motion, map);
  std::vector<double> joints(3 * kinect_joint_count);
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (; count <= motion.length_s; ++count) {  // the position is taken once a second
    joints_of(count, joints);
    sum += vec3(joints, spine_base);
  }
  joints_of(0.0, joints);
  const double floor = lowest_of(motion.skeleton, joints_of.global());
  // The camera looks at the middle of the path, so that the person stays in view.
  const Vec3 middle = sum / count;
  Vec3 facing = (vec3(joints, hip_left) - vec3(joints, hip_right)).cross(Vec3::UnitY());
  // If the hips are above each other, the front is unknown.
  if (facing.norm() < 1e-3) facing = Vec3::UnitZ();

  const RandomStream random = draws(seed);
  const auto near = [&](std::uint64_t lane) { return 2.0 * random.uniform(0, lane) - 1.0; };
  const double yaw = std::atan2(facing.x(), facing.z()) + 15.0 * degree * near(0);
  const double away = 2.85 + 0.15 * near(1);
  RigidTransform camera;
  camera.translation = Vec3(middle.x() + away * std::sin(yaw), floor + 1.05 + 0.15 * near(2),
                            middle.z() + away * std::cos(yaw));
  // The camera faces the person, with deviations of some degrees.
  camera.rotation =
      Quat(Eigen::AngleAxisd(yaw + std::numbers::pi + 3.0 * degree * near(3), Vec3::UnitY()) *
           Eigen::AngleAxisd(3.0 * degree * near(4), Vec3::UnitX()) *
           Eigen::AngleAxisd(1.0 * degree * near(5), Vec3::UnitZ()));
  return camera;
}

// The devices are simulated one after another. Each has its own random numbers, so a change of one
// device does not change the others.
Result<Rehearsal> rehearse(const Motion& motion, const RehearsalOptions& options) {
  if (!(motion.length_s >= least_rehearsal_s)) {
    return Failure(
        Error{"", 0, "a motion of at least 3 s", std::to_string(motion.length_s) + " s"});
  }
  const std::uint64_t seed = options.seed;
  Rehearsal done;
  done.mocap = mocap_run(motion.length_s, seed);

  const KinectMap map = KA_TRY(kinect_map(motion.skeleton));
  done.camera.world_from_kinect = KA_TRY(camera_before(motion, seed));
  // The error of the sensor's crystal is at most 20 ppm, as for a node.
  done.camera.drift_ppm = 40.0 * draws(seed).uniform(0, 6) - 20.0;
  const KinectIds ids{.seed = seed, .person = options.person.value_or(seed)};
  done.ticks = kinect_ticks(done.camera, ids, 0.0, motion.length_s);
  JointsOf joints_of(motion, map);
  done.kinect = simulate_kinect(std::ref(joints_of), done.ticks, done.camera, ids);

  InertialNodeOptions nodes;
  nodes.rate_hz = options.node_rate_hz;
  const auto mountings = KA_TRY(five_nodes(motion.skeleton, seed));
  done.nodes = KA_TRY(simulate_nodes(motion, mountings, nodes, seed));
  return done;
}

// Returns only a part of the run, so that a long motion needs little memory.
ClipFrames mocap_frames(const Motion& motion, const MocapRun& run, std::size_t begin,
                        std::size_t end, Time zero) {
  const std::size_t joints = motion.skeleton.joints();
  ClipFrames frames;
  frames.local_positions.resize(3 * joints * (end - begin));
  frames.local_rotations.resize(4 * joints * (end - begin));
  Pose pose;
  for (std::size_t k = begin; k < end; ++k) {
    motion.pose_at(run.frame_s(k), pose);
    frames.stamps.push_back(time_at(zero, run.frame_s(k)));
    for (std::size_t j = 0; j < joints; ++j) {
      vec3(frames.local_positions, (k - begin) * joints + j) = pose.local_positions[j];
      put_quat(frames.local_rotations, (k - begin) * joints + j, pose.local_rotations[j]);
    }
  }
  return frames;
}

// Only the first stamp is true. The others are counted from it by the sensor's clock with its
// drift.
PointStream kinect_file(const Rehearsal& rehearsal, Time zero) {
  PointStream stream{{kinect_joints.begin(), kinect_joints.end()}, rehearsal.kinect};
  if (rehearsal.ticks.empty()) return stream;
  const KinectTick& first = rehearsal.ticks.front();
  for (std::size_t i = 0; i < rehearsal.ticks.size(); ++i) {
    stream.frames.stamps[i] =
        time_at(zero, first.seconds) +
        std::chrono::nanoseconds(100 * (rehearsal.ticks[i].device - first.device));
  }
  return stream;
}

// The counter's reading at time 0 is subtracted. The stamp at time 0 is therefore true; later
// stamps drift.
ImuStream node_file(const SimulatedNode& node, Time zero) {
  return imu_stream(node, time_at(zero, -SimulatedClock(node.seed, 1.0).reading(0.0)));
}

// The link decides only which samples are lost. The stamps are those of the node.
ImuStream received_node(const SimulatedNode& node, Link link, Time zero) {
  const auto arrivals = transmit({.link = link}, node.seed, Way::up, node.truth.times);
  const ImuStream all = node_file(node, zero);
  ImuStream out{all.node_names, all.content, {}};
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (arrivals[i].first) append_sample(all.samples, i, all.samples.stamps[i], out.samples);
  }
  return out;
}

// Samples are sorted by arrival, in the order in which a host would write them.
ArrivedNode arrived_node(const SimulatedNode& node, Link link, Time zero) {
  const auto arrivals = transmit({.link = link}, node.seed, Way::up, node.truth.times);
  std::vector<std::pair<double, std::size_t>> arrived;  // arrival and index of each sample
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (arrivals[i].first) arrived.emplace_back(*arrivals[i].first, i);
  }
  std::sort(arrived.begin(), arrived.end());
  const ImuStream all = imu_stream(node, Time{});
  ArrivedNode out{{all.node_names, all.content, {}}, {}};
  for (const auto& [at, i] : arrived) {
    append_sample(all.samples, i, time_at(zero, at), out.stream.samples);
    out.clock.stamps_ns.push_back(to_ns(out.stream.samples.stamps.back()));
    out.clock.times_ns.push_back(to_ns(time_at(zero, node.truth.times[i])));
  }
  return out;
}

// The stream names are those of the simulated files.
TrueRecording truth_of(const Rehearsal& rehearsal, const Motion& motion, Time zero) {
  TrueRecording truth;
  truth.length_s = motion.length_s;
  truth.start_ns = to_ns(zero);
  const MocapRun& run = rehearsal.mocap;
  const auto ns = [&](double s) { return to_ns(time_at(zero, s)); };
  truth.mocap = {"mocap",
                 run.rate_hz,
                 run.frames,
                 ns(run.start_click_s),
                 ns(run.stop_click_s),
                 ns(run.first_frame_s)};
  truth.kinect = {"kinect", rehearsal.camera.world_from_kinect, rehearsal.camera.drift_ppm,
                  kinect_clock(rehearsal, zero)};
  for (const SimulatedNode& node : rehearsal.nodes) {
    truth.nodes.push_back(true_node(node, motion, zero));
    truth.nodes.back().id = static_cast<std::uint32_t>(truth.nodes.size());
  }
  return truth;
}

}  // namespace kinalign
