// SPDX-License-Identifier: Apache-2.0
// The truth about a simulated recording: facts that no device can measure. The file is described in
// docs/formats/truth.md.
#pragma once

#include "kinalign/motion/rigid_fit.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The limit of stamps and times, positive or negative (2033). Sums of a few times fit into 64
/// bits.
inline constexpr std::int64_t most_true_ns = 2'000'000'000'000'000'000;

/// Rising stamps of a device and their true times. Between them, time is interpolated linearly.
/// Clocks drift slowly, so a few pairs describe a long recording.
struct TrueClock {
  std::vector<std::int64_t> stamps_ns;  // stamps in the device's file or packets
  std::vector<std::int64_t> times_ns;   // UTC
};

/// Returns the true time of a stamp. Outside the known stamps, it is extrapolated from the nearest
/// two. Absent if fewer than two are known.
std::optional<Time> true_time(const TrueClock& clock, Time stamp);

/// The stream of the motion capture suit. Its file has no stamps, so the clicks on record and stop
/// are part of the truth.
struct TrueMocap {
  std::string stream;
  double rate_hz = 0.0;
  std::uint64_t frames = 0;
  std::int64_t start_click_ns = 0, stop_click_ns = 0, first_frame_ns = 0;  // UTC

  std::int64_t frame_ns(std::uint64_t frame) const;
};

/// The stream of the Kinect, and the position of the Kinect.
struct TrueKinect {
  std::string stream;
  RigidTransform world_from_kinect;
  double drift_ppm = 0.0;  // of the Kinect's clock; 1: fast by 1e-6
  TrueClock clock;
};

/// One inertial node: its position and orientation on the body, and the errors of its sensors and
/// clock.
struct TrueNode {
  std::string stream, node, joint;  // worn on the bone that begins at this joint
  std::uint32_t id = 0;
  Vec3 offset = Vec3::Zero();  // m, from the joint, in the joint's space
  Quat bone_from_sensor = Quat::Identity();
  double sensor_delay_ms = 0.0;  // delay of a movement by the sensor's filters
  Vec3 gyroscope_zero = Vec3::Zero(), accelerometer_zero = Vec3::Zero();  // rad/s, m/s2
  TrueClock clock;
};

/// The two clocks of the sending machine, read at the same time.
struct TrueHost {
  std::int64_t raw_ns = 0, utc_ns = 0;
};

/// The truth about one simulated recording. Tests and benchmarks compare takes with it.
struct TrueRecording {
  std::uint64_t seed = 0;
  std::string motion;       // "built-in", or the file of the motion
  std::string motion_file;  // a BVH of the motion, relative to the file of the truth
  double length_s = 0.0;
  std::int64_t start_ns = 0;  // UTC of time 0 of the motion
  /// Set for a recording that was sent live. `times_ns` are then CLOCK_MONOTONIC_RAW of this host +
  /// utc_ns - raw_ns.
  std::optional<TrueHost> host;
  std::string link;  // simulated radio link of the nodes, "A" to "G" (docs/simulated_links.md);
                     // empty: none
  TrueMocap mocap;
  TrueKinect kinect;
  std::vector<TrueNode> nodes;
};

}  // namespace kinalign
