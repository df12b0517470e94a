// SPDX-License-Identifier: Apache-2.0
// A simulated Kinect v2. From the true joints of a body it computes the output of the body-tracking
// SDK. docs/kinect_noise.md describes the model, the measurements and the comparison with real
// recordings. Time is simulated; the same seed and ids give the same bytes.
#pragma once

#include "kinalign/motion/rigid_fit.h"
#include "kinalign/motion/streams.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kinalign {

/// The volume in which a camera sees joints: published range, and a field of view of 70.6 x 60
/// degrees.
struct KinectView {
  double nearest = 0.5, farthest = 4.5;  // m along the optical axis
  double slope_x = 0.708, slope_y = 0.577;
};

/// Parts of the model. Each part can be switched off; if all are off, the reported joints are the
/// true ones.
struct KinectParts {
  bool uneven_stamps = true;  // off: a frame every 33.33 ms
  bool bias = true;
  bool coloured = true;
  bool soft_bones = true;
  bool white = true;
  bool twitches = true;
  bool occlusion = true;
  bool exchange = true;
  bool view = true;  // off: every position is in view
};

struct KinectOptions {
  RigidTransform world_from_kinect{};  // camera space: x to the sensor's left, y up, z to the front
  KinectView view{};
  KinectRadii radii{};
  KinectParts parts{};
  double drop_rate = 0.005;     // share of frames that are dropped
  double drift_ppm = 0.0;       // drift of the sensor's clock; 1: 1 ppm fast
  std::int64_t first_tick = 0;  // the clock's reading when the sensor starts, 100 ns
};

/// Selects the random draws, together with the seed. Two cameras on one take have the same person
/// and take.
struct KinectIds {
  std::uint64_t seed = 1, person = 1, take = 1, camera = 0;
};

/// One frame of the sensor.
struct KinectTick {
  std::int64_t number = 0;  // number of the frame; dropped frames are counted too
  double seconds = 0.0;     // true time of the frame, s
  std::int64_t device = 0;  // the sensor's own clock, 100 ns
};

/// Returns the sensor's frames up to `end_s`. The time of the first frame is drawn within one frame
/// period after `begin_s`.
std::vector<KinectTick> kinect_ticks(const KinectOptions& options, const KinectIds& ids,
                                     double begin_s, double end_s);

/// Fills the 25 true joints [25,3] m at a time in s, in a world with y up.
using KinectJointsAt = std::function<void(double seconds, std::span<double> joints)>;

/// Returns the sensor's output for one body: [T,25,3] m in camera space. The stamps are the
/// sensor's clock readings since the epoch. If the trunk is out of view, no body is reported and
/// all 25 joints are missing.
PointFrames simulate_kinect(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                            const KinectOptions& options, const KinectIds& ids);

}  // namespace kinalign
