// SPDX-License-Identifier: Apache-2.0
// A simulated Kinect v2: what the body-tracking SDK would have said of a body whose true joints are
// known at any time. Model, measurements and the table that holds it against real recordings:
// docs/kinect_noise.md. Virtual time; the same seed and ids give the same bytes.
#pragma once

#include "kinalign/motion/rigid_fit.h"
#include "kinalign/motion/streams.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kinalign {

/// Where a camera sees joints: published range and field of view of 70.6 x 60 degrees.
struct KinectView {
  double nearest = 0.5, farthest = 4.5;  // m along the optical axis
  double slope_x = 0.708, slope_y = 0.577;
};

/// The parts of the model, each of which can be left out; without any of them the joints are true.
struct KinectParts {
  bool uneven_stamps = true;  // off: a frame every 33.33 ms
  bool bias = true;
  bool coloured = true;
  bool soft_bones = true;
  bool white = true;
  bool twitches = true;
  bool occlusion = true;
  bool exchange = true;
  bool view = true;  // off: seen at any place
};

struct KinectOptions {
  RigidTransform world_from_kinect{};  // camera space: x to the sensor's left, y up, z to the front
  KinectView view{};
  KinectRadii radii{};
  KinectParts parts{};
  double drop_rate = 0.005;     // share of frames
  double drift_ppm = 0.0;       // of the sensor's clock: 1 ppm fast …
  std::int64_t first_tick = 0;  // … and its reading when the sensor begins, 100 ns
};

/// What draws depend on beside the seed. Two cameras on one take share person and take.
struct KinectIds {
  std::uint64_t seed = 1, person = 1, take = 1, camera = 0;
};

/// One frame that the sensor gave.
struct KinectTick {
  std::int64_t number = 0;  // of the frame; dropped ones are counted
  double seconds = 0.0;     // true time
  std::int64_t device = 0;  // 100 ns on the sensor's own clock
};

/// The frames of a sensor from `begin_s` (drawn within a frame after it) until `end_s`.
std::vector<KinectTick> kinect_ticks(const KinectOptions& options, const KinectIds& ids,
                                     double begin_s, double end_s);

/// The 25 true joints [25,3] m at a time, s, in a world that is y up.
using KinectJointsAt = std::function<void(double seconds, std::span<double> joints)>;

/// What the sensor says of one body: [T,25,3] m in camera space, stamps its device ticks from the
/// epoch on. Where the trunk is out of view there is no body: 25 missing joints.
PointFrames simulate_kinect(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                            const KinectOptions& options, const KinectIds& ids);

}  // namespace kinalign
