// SPDX-License-Identifier: Apache-2.0
// Simulates the recordings of one motion by a suit, a Kinect and five nodes, together with the
// truth. Times are those of the motion, s. The nodes and the camera record all of it, the suit from
// a click on «record» to one on «stop».
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/nodes/inertial_nodes.h"
#include "kinalign/simulate/nodes/link.h"
#include "kinalign/take/truth.h"

#include <optional>

namespace kinalign {

inline constexpr double least_rehearsal_s = 3.0;  // two clicks and a second between them

/// A suit's program knows neither when a click takes effect nor the time of a frame.
struct MocapRun {
  double rate_hz = 60.0;
  double start_click_s = 0.0, stop_click_s = 0.0;
  double first_frame_s = 0.0;
  std::size_t frames = 0;

  double frame_s(std::size_t k) const { return first_frame_s + static_cast<double>(k) / rate_hz; }
};

/// Mean delay from a click to the first frame: 45 ms with a deviation of 6 ms, an estimate,
/// plus half a frame until the next one is due.
inline constexpr double click_latency_s = 0.045 + 0.5 / 60.0;

/// Greater than the drift of any crystal in node_clock.h and of the camera's.
inline constexpr double most_drift = 25e-6;

/// The same options give the same rehearsal, on any machine.
struct RehearsalOptions {
  std::uint64_t seed = 1;
  std::uint32_t node_rate_hz = 100;
  std::optional<std::uint64_t> person{};  // person whose body the camera sees; absent: the seed's
};

/// Everything that the devices would have recorded. Their files and their live streams are made
/// from it.
struct Rehearsal {
  MocapRun mocap;
  KinectOptions camera;
  std::vector<KinectTick> ticks;
  PointFrames kinect;  // at the ticks; the sensor's stamps, counted from the epoch
  std::vector<SimulatedNode> nodes;
};

/// Fails if the motion is shorter than least_rehearsal_s, or if its skeleton is not supported by
/// the camera (kinect_map.h) or the nodes (five_nodes).
Result<Rehearsal> rehearse(const Motion& motion, const RehearsalOptions& options);

/// The suit's frames from `begin` to before `end`; `zero` is the stamp of time 0.
ClipFrames mocap_frames(const Motion& motion, const MocapRun& run, std::size_t begin,
                        std::size_t end, Time zero);

/// A camera on a tripod, 0.9 to 1.2 m above the floor, not quite level. It stands 2.7 to 3.0 m in
/// front of the middle of the person's path, up to 15 degrees off the person's first line of sight.
Result<RigidTransform> camera_before(const Motion& motion, std::uint64_t seed);

/// The camera's stream with the stamps of a program on the host that knew the time of the first
/// frame and used the sensor's clock from then on.
PointStream kinect_file(const Rehearsal& rehearsal, Time zero);

/// The stream of a node with stamps by its counter, whose first value was stamped correctly.
ImuStream node_file(const SimulatedNode& node, Time zero);

/// The stream of node_file() without the samples that the link loses. Each sample has its own
/// packet.
ImuStream received_node(const SimulatedNode& node, Link link, Time zero);

/// The stream of a node without a clock, as in the paper: each sample has its own packet and is
/// stamped on arrival. Lost samples are absent.
struct ArrivedNode {
  ImuStream stream;
  TrueClock clock;  // pairs of the arrivals' stamps and the true times
};
ArrivedNode arrived_node(const SimulatedNode& node, Link link, Time zero);

/// The truth about all devices, with the devices' own clocks and not those of arrivals.
TrueRecording truth_of(const Rehearsal& rehearsal, const Motion& motion, Time zero);

/// The time `seconds_behind` s after `zero`, to the nanosecond; all stamps of a rehearsal are made
/// so.
inline Time time_at(Time zero, double seconds_behind) {
  return zero + Duration{static_cast<std::int64_t>(std::llround(seconds_behind * 1e9))};
}

}  // namespace kinalign
