// SPDX-License-Identifier: Apache-2.0
// One motion as a suit, a Kinect and five nodes would have recorded it, with the truth beside it.
// Times are the motion's, s: the nodes and the camera run through all of it, the suit from a click
// on «record» to one on «stop».
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/nodes/inertial_nodes.h"
#include "kinalign/simulate/nodes/link.h"
#include "kinalign/take/truth.h"

#include <optional>

namespace kinalign {

inline constexpr double least_rehearsal_s = 3.0;  // two clicks and a second between them

/// A suit's program knows neither when a click took effect nor the time of a frame.
struct MocapRun {
  double rate_hz = 60.0;
  double start_click_s = 0.0, stop_click_s = 0.0;
  double first_frame_s = 0.0;
  std::size_t frames = 0;

  double frame_s(std::size_t k) const { return first_frame_s + static_cast<double>(k) / rate_hz; }
};

/// Delay from a click to the first frame, in the mean: 45 ms with a deviation of 6, an estimate
/// (time-sync.md 4.9 has the same), and half a frame until the next one is due.
inline constexpr double click_latency_s = 0.045 + 0.5 / 60.0;

/// Beyond any crystal of node_clock.h, and of the camera's.
inline constexpr double most_drift = 25e-6;

struct RehearsalOptions {
  std::uint64_t seed = 1;
  std::uint32_t node_rate_hz = 100;
  std::optional<std::uint64_t> person{};  // whose body the camera sees, where not the seed's
};

struct Rehearsal {
  MocapRun mocap;
  KinectOptions camera;
  std::vector<KinectTick> ticks;
  PointFrames kinect;  // of the ticks; stamps are the sensor's, from the epoch on
  std::vector<SimulatedNode> nodes;
};

/// Fails where the motion is shorter than least_rehearsal_s, or where its skeleton is none that a
/// camera (kinect_map.h) and nodes (five_nodes) are known for.
Result<Rehearsal> rehearse(const Motion& motion, const RehearsalOptions& options);

/// The suit's frames from `begin` until `end`; `zero` is the stamp of time 0.
ClipFrames mocap_frames(const Motion& motion, const MocapRun& run, std::size_t begin,
                        std::size_t end, Time zero);

/// A camera on a tripod, 0.9 to 1.2 m above the floor and 2.7 to 3.0 m before the middle of where
/// the person goes, up to 15 degrees beside where they face at first, not quite level.
Result<RigidTransform> camera_before(const Motion& motion, std::uint64_t seed);

/// As a program on the host would have stamped the camera's frames that was right about the first
/// one, and believed the sensor's clock from then on.
PointStream kinect_file(const Rehearsal& rehearsal, Time zero);

/// Likewise a node, whose counter was read when it stood at its first value.
ImuStream node_file(const SimulatedNode& node, Time zero);

/// The stream of node_file() without the samples that the link loses. Each sample has its own
/// packet.
ImuStream received_node(const SimulatedNode& node, Link link, Time zero);

/// Each sample in a packet of its own over the link, stamped when it arrived: as the paper's nodes
/// without a clock. What is lost is not there.
struct ArrivedNode {
  ImuStream stream;
  TrueClock clock;  // of each arrival
};
ArrivedNode arrived_node(const SimulatedNode& node, Link link, Time zero);

/// Without clocks of arrivals: those of the devices.
TrueRecording truth_of(const Rehearsal& rehearsal, const Motion& motion, Time zero);

/// ns to a second on; as all stamps of a rehearsal are made.
inline Time time_at(Time zero, double seconds_behind) {
  return zero + Duration{static_cast<std::int64_t>(std::llround(seconds_behind * 1e9))};
}

}  // namespace kinalign
