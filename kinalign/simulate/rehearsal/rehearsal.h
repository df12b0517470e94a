// SPDX-License-Identifier: Apache-2.0
// Simulates the recordings of one motion by a motion capture suit, a Kinect and five inertial
// nodes, together with the truth. Times are those of the motion, s. The nodes and the Kinect record
// the whole motion, the suit from a click on «record» to a click on «stop».
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/nodes/inertial_nodes.h"
#include "kinalign/simulate/nodes/link.h"
#include "kinalign/take/truth.h"

#include <optional>

namespace kinalign {

inline constexpr double least_rehearsal_s = 3.0;  // two clicks, with one second between them

/// The recording of the suit. The suit's program knows neither when a click takes effect nor the
/// time of a frame.
struct MocapRun {
  double rate_hz = 60.0;
  double start_click_s = 0.0, stop_click_s = 0.0;
  double first_frame_s = 0.0;
  std::size_t frames = 0;

  double frame_s(std::size_t k) const { return first_frame_s + static_cast<double>(k) / rate_hz; }
};

/// Mean delay from a click to the first frame: 45 ms (an estimate, with a deviation of 6 ms) plus
/// half a frame period.
inline constexpr double click_latency_s = 0.045 + 0.5 / 60.0;

/// Greater than the drift of any crystal in node_clock.h and of the Kinect's clock.
inline constexpr double most_drift = 25e-6;

/// The same options give the same result on any machine.
struct RehearsalOptions {
  std::uint64_t seed = 1;
  std::uint32_t node_rate_hz = 100;
  std::optional<std::uint64_t> person{};  // person whom the Kinect sees; absent: given by `seed`
};

/// The simulated recordings of all devices. Files and live streams are made from them.
struct Rehearsal {
  MocapRun mocap;
  KinectOptions camera;
  std::vector<KinectTick> ticks;
  PointFrames kinect;  // at the ticks; the stamps are the sensor's clock readings since the epoch
  std::vector<SimulatedNode> nodes;
};

/// Simulates all devices. Fails if the motion is shorter than least_rehearsal_s, or if the Kinect
/// (kinect_map.h) or the nodes (five_nodes) do not support its skeleton.
Result<Rehearsal> rehearse(const Motion& motion, const RehearsalOptions& options);

/// Returns the suit's frames from `begin` to `end`, without `end`. `zero` is the stamp of time 0.
ClipFrames mocap_frames(const Motion& motion, const MocapRun& run, std::size_t begin,
                        std::size_t end, Time zero);

/// Returns the position of a camera on a tripod, 0.9 to 1.2 m above the floor and not quite level.
/// It is 2.7 to 3.0 m in front of the middle of the person's path, up to 15 degrees off the
/// person's first viewing direction.
Result<RigidTransform> camera_before(const Motion& motion, std::uint64_t seed);

/// Returns the Kinect's stream as a program on the host would stamp it: the first frame gets its
/// true time, and the sensor's clock gives all others.
PointStream kinect_file(const Rehearsal& rehearsal, Time zero);

/// Returns the stream of a node with stamps by its counter. The stamp at time 0 is true.
ImuStream node_file(const SimulatedNode& node, Time zero);

/// Returns node_file() without the samples that the link loses. Each sample has its own packet.
ImuStream received_node(const SimulatedNode& node, Link link, Time zero);

/// The stream of a node without a clock, as in the HFUT-MMD paper: each sample has its own packet
/// and is stamped on arrival. Lost samples are absent.
struct ArrivedNode {
  ImuStream stream;
  TrueClock clock;  // pairs of arrival stamp and true time
};
ArrivedNode arrived_node(const SimulatedNode& node, Link link, Time zero);

/// Returns the truth about all devices. The clocks are the devices' own, not those of arrivals.
TrueRecording truth_of(const Rehearsal& rehearsal, const Motion& motion, Time zero);

/// Returns the time that is `seconds_behind` s after `zero`, to the nanosecond. All stamps of a
/// rehearsal are made by this function.
inline Time time_at(Time zero, double seconds_behind) {
  return zero + Duration{static_cast<std::int64_t>(std::llround(seconds_behind * 1e9))};
}

}  // namespace kinalign
