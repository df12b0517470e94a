// SPDX-License-Identifier: Apache-2.0
// Random numbers (random.h): stream 115 of a node's seed has these lanes: 0 the phase of the timer
// (number 0), 1 the delay of reading after each tick, by tick. The pass computes the pose of the
// body at every chip step. The last five poses give the true reading at the middle pose.
#include "kinalign/simulate/nodes/inertial_nodes.h"

#include <cmath>
#include <memory>
#include <string>

namespace kinalign {

namespace {

// Delay from the timer to the reading, estimated for a task of high priority on an idle core.
constexpr double service_s = 15e-6;

/// The timer's ticks on the node's counter, and the times at which the samples are read.
class NodeTimer {
 public:
  NodeTimer(const InertialNodeOptions& options, std::uint64_t seed, double length_s)
      : clock_(seed, length_s, options.clock),
        random_(seed, 115),
        // In whole microseconds, as in the firmware.
        period_us_(1'000'000 / options.rate_hz) {
    const double phase = static_cast<double>(period_us_) * random_.uniform(0, 0);
    // The first tick comes within one period.
    next_us_ = static_cast<std::uint64_t>(clock_.reading(0.0) * 1e6 + phase) + 1;
    plan();
  }

  double served_s() const { return served_s_; }
  std::uint64_t counter_us() const {
    return static_cast<std::uint64_t>(clock_.reading(served_s_) * 1e6);
  }
  /// Returns the true time at which the counter had this value.
  double true_s(std::uint64_t counter_us) const {
    return clock_.host(static_cast<double>(counter_us) * 1e-6);
  }
  void advance() {
    next_us_ += period_us_;
    ++tick_;
    plan();
  }

 private:
  /// A task reads the sample shortly after the tick. The sample gets the counter value at that
  /// time.
  void plan() { served_s_ = true_s(next_us_) + random_.exponential(tick_, 1, service_s); }

  SimulatedClock clock_;
  RandomStream random_;
  std::uint64_t period_us_, next_us_ = 0, tick_ = 0;
  double served_s_ = 0.0;
};

/// Returns the mean rate of a sensor at rest, rad/s.
Vec3 mean_rate_at_rest(SimulatedSensor& sensor, const Vec3& gravity, double rest_s) {
  const auto steps = static_cast<std::size_t>(rest_s * chip_rate_hz);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < steps; ++i) {
    sum += sensor.reading_of(sensor.step({Vec3::Zero(), gravity})).angular_velocity;
  }
  return steps == 0 ? sum : Vec3(sum / static_cast<double>(steps));
}

// Before it is worn, the node is at rest with z up, and the filter measures the bias. Afterwards
// the zero offsets drift.
MahonyOptions calibrated(const InertialNodeOptions& options, SimulatedSensor& sensor) {
  MahonyOptions filter = options.filter;
  if (!(options.rest_s > 0.0)) return filter;
  filter.gyroscope_bias = mean_rate_at_rest(sensor, Vec3(0, 0, standard_gravity), options.rest_s);
  sensor.wait(options.worn_s);
  return filter;
}

/// One node during the pass: chip, filter, timer and the samples so far. All nodes advance
/// together, so that each pose is computed only once per chip step.
class NodeAtWork {
 public:
  NodeAtWork(const Mounting& mounting, const InertialNodeOptions& options, std::uint64_t seed,
             double length_s)
      : options_(options),
        sensor_(options.sensor, seed),
        filter_(calibrated(options, sensor_)),
        timer_(options, seed, length_s) {
    node_.mounting = mounting;
    node_.seed = seed;
  }

  /// Runs the chip for one step. Its reading belongs to the middle of the last five poses. Call for
  /// each chip step in order.
  void chip_step(const std::array<const GlobalPose*, 5>& poses) {
    std::array<SensorPlace, 5> places;
    for (std::size_t k = 0; k < 5; ++k) places[k] = place_of(node_.mounting, *poses[k]);
    registers_ = sensor_.step(true_reading(places, chip_step_s));
    if (options_.orientation) filter_.update(chip_step_s, sensor_.reading_of(registers_));
  }

  /// Takes a sample for each tick that is read before `t`. The registers don't change until then.
  void serve(double t, const Motion& motion) {
    for (; timer_.served_s() < t; timer_.advance()) {
      SimulatedNodeSample taken{timer_.counter_us(), sensor_.sample_of(registers_)};
      if (options_.orientation) {
        const Quat& q = filter_.orientation();
        taken.sample.has_orientation = true;
        taken.sample.orientation = {static_cast<float>(q.w()), static_cast<float>(q.x()),
                                    static_cast<float>(q.y()), static_cast<float>(q.z())};
      }
      // The counter is truncated to microseconds. The truth is that of the truncated time.
      const double true_s = timer_.true_s(taken.counter_us);
      motion.pose_at(true_s, pose_);
      forward_kinematics(motion.skeleton, pose_, global_);
      node_.samples.push_back(taken);
      node_.truth.times.push_back(true_s);
      node_.truth.places.push_back(place_of(node_.mounting, global_));
    }
  }
  /// Skips ticks for which there are no registers yet.
  void skip(double t) {
    while (timer_.served_s() < t) timer_.advance();
  }

  SimulatedNode take() {
    node_.errors = sensor_.errors();
    return std::move(node_);
  }

 private:
  const InertialNodeOptions& options_;
  SimulatedSensor sensor_;
  MahonyFilter filter_;
  NodeTimer timer_;
  SimulatedNode node_;
  RawReading registers_;
  Pose pose_;
  GlobalPose global_;
};

Result<void> check(const Motion& motion, const std::vector<Mounting>& mountings,
                   const InertialNodeOptions& options) {
  if (options.rate_hz < 1 || options.rate_hz > 1000) {
    return Failure(Error{"", 0, "a rate of 1 to 1000 Hz", std::to_string(options.rate_hz) + " Hz"});
  }
  for (const Mounting& mounting : mountings) {
    if (mounting.joint < motion.skeleton.joints()) continue;
    return Failure(Error{"", 0, "a joint of the skeleton for node " + mounting.node_name,
                         "joint " + std::to_string(mounting.joint)});
  }
  return {};
}

}  // namespace

Result<std::vector<SimulatedNode>> simulate_nodes(const Motion& motion,
                                                  const std::vector<Mounting>& mountings,
                                                  const InertialNodeOptions& options,
                                                  std::uint64_t seed) {
  KA_TRY(check(motion, mountings, options));
  std::vector<std::unique_ptr<NodeAtWork>> nodes;
  for (std::size_t n = 0; n < mountings.size(); ++n) {
    nodes.push_back(
        std::make_unique<NodeAtWork>(mountings[n], options, mix64(seed) + n, motion.length_s));
    nodes.back()->skip(2.0 * chip_step_s);  // there is no reading before that
  }
  std::array<GlobalPose, 5> poses;  // pose i of the motion has the index i % 5
  Pose pose;
  const auto steps = static_cast<std::size_t>(motion.length_s * chip_rate_hz + 1e-6);
  for (std::size_t i = 0; i <= steps; ++i) {
    motion.pose_at(static_cast<double>(i) * chip_step_s, pose);
    forward_kinematics(motion.skeleton, pose, poses[i % 5]);
    // The first reading needs five poses.
    if (i < 4) continue;
    std::array<const GlobalPose*, 5> last{};
    for (std::size_t k = 0; k < 5; ++k) last[k] = &poses[(i + 1 + k) % 5];
    for (const auto& node : nodes) {
      node->chip_step(last);
      // The reading belongs to pose i - 2. Its registers are valid until the time of pose i - 1.
      node->serve(static_cast<double>(i - 1) * chip_step_s, motion);
    }
  }
  std::vector<SimulatedNode> done;
  done.reserve(nodes.size());
  for (const auto& node : nodes) done.push_back(node->take());
  return done;
}

// All samples are valid here. rehearsal.h removes the samples that a link loses.
ImuStream imu_stream(const SimulatedNode& node, Time start) {
  ImuStream stream;
  stream.node_names = {node.mounting.node_name};
  const bool oriented = !node.samples.empty() && node.samples.front().sample.has_orientation;
  stream.content = {oriented, true, true, true};
  ImuSamples& to = stream.samples;
  for (const auto& [counter_us, sample] : node.samples) {
    to.stamps.push_back(start + std::chrono::microseconds(counter_us));
    if (oriented) {
      to.orientation.insert(to.orientation.end(), sample.orientation.begin(),
                            sample.orientation.end());
    }
    to.acceleration.insert(to.acceleration.end(), sample.acceleration.begin(),
                           sample.acceleration.end());
    to.angular_velocity.insert(to.angular_velocity.end(), sample.angular_velocity.begin(),
                               sample.angular_velocity.end());
  }
  to.valid.assign(to.stamps.size(), 1);
  return stream;
}

}  // namespace kinalign
