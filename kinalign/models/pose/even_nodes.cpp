// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/even_nodes.h"

#include "kinalign/motion/mahony.h"
#include "kinalign/motion/rotation.h"
#include "kinalign/motion/stamps.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double gravity_m_s2 = 9.80665;
constexpr double longest_node_gap_s = 0.2;
constexpr double most_node_frames = 1e7;

double seconds_between(Time from, Time to) {
  return static_cast<double>(to_ns(to) - to_ns(from)) * 1e-9;
}

/// Estimates the orientations from angular velocity and acceleration.
void make_orientation(NodeTrack& track) {
  MahonyFilter filter;
  track.orientation.resize(4 * track.stamps.size());
  for (std::size_t i = 0; i < track.stamps.size(); ++i) {
    // The first sample has no step before it; 1 ms stands in for it. live_nodes.cpp does the same.
    const double step = i == 0 ? 1e-3 : seconds_between(track.stamps[i - 1], track.stamps[i]);
    filter.update(step, {vec3(track.angular_velocity, i), vec3(track.acceleration, i)});
    put_quat(track.orientation, i, filter.orientation());
  }
}

void make_angular_velocity(NodeTrack& track) {
  const std::size_t samples = track.stamps.size();
  track.angular_velocity.assign(3 * samples, 0.0);
  for (std::size_t i = 0; i + 1 < samples; ++i) {
    // The rotation to the next sample, in the node's own space. The last sample keeps 0.
    const Quat turn = quat(track.orientation, i).conjugate() * quat(track.orientation, i + 1);
    vec3(track.angular_velocity, i) =
        rotation_vector(turn.normalized()) / seconds_between(track.stamps[i], track.stamps[i + 1]);
  }
}

/// One node's samples, prepared for evaluation at any time. Accelerations are rotated into the
/// world before they are averaged: in the space of a turning node, the mean would mix directions.
/// `track` must outlive this object.
class NodeCurve {
 public:
  explicit NodeCurve(const NodeTrack& track) : track_(track) {
    world_.resize(track.acceleration.size());
    const Vec3 gravity(0.0, track.gravity ? gravity_m_s2 : 0.0, 0.0);
    for (std::size_t i = 0; i < track.stamps.size(); ++i) {
      vec3(world_, i) =
          quat(track.orientation, i).normalized() * vec3(track.acceleration, i) - gravity;
    }
  }

  /// Writes the node's sample at `time` to place `at`, if `time` is between two samples at most 0.2
  /// s apart. Times must rise from call to call.
  void put(Time time, std::size_t at, double rate_hz, WornFrames& out) {
    const auto& stamps = track_.stamps;
    while (next_ < stamps.size() && stamps[next_] < time) ++next_;
    if (next_ == stamps.size() || (next_ == 0 && stamps[0] != time)) return;
    const std::size_t before = next_ == 0 ? 0 : next_ - 1;
    const double gap = seconds_between(stamps[before], stamps[next_]);
    if (gap > longest_node_gap_s) return;
    const double share = gap > 0.0 ? seconds_between(stamps[before], time) / gap : 0.0;
    const Quat q = quat(track_.orientation, before)
                       .normalized()
                       .slerp(share, quat(track_.orientation, next_).normalized());
    const std::array<double, 4> parts{q.w(), q.x(), q.y(), q.z()};
    for (std::size_t k = 0; k < 4; ++k) out.orientation[4 * at + k] = static_cast<float>(parts[k]);
    put_mean(world_, time, std::max(acceleration_within_s, gap), &out.acceleration[3 * at]);
    put_mean(track_.angular_velocity, time, std::max(0.5 / rate_hz, gap),
             &out.angular_velocity[3 * at]);
    out.valid[at] = 1;
  }

 private:
  /// The mean of the samples nearer than `within_s`, weighted by 1 - distance / within_s.
  void put_mean(const std::vector<double>& values, Time time, double within_s, float* out) const {
    const auto& stamps = track_.stamps;
    const Duration reach{std::llround(within_s * 1e9)};
    auto i = static_cast<std::size_t>(std::lower_bound(stamps.begin(), stamps.end(), time - reach) -
                                      stamps.begin());
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (; i < stamps.size() && stamps[i] <= time + reach; ++i) {
      const double weight = 1.0 - std::abs(seconds_between(time, stamps[i])) / within_s;
      if (weight <= 0.0) continue;
      sum += weight * vec3(values, i);
      weights += weight;
    }
    for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(sum(k) / weights);
  }

  const NodeTrack& track_;
  std::vector<double> world_;  // [T,3] m/s2, acceleration in the world without gravity
  std::size_t next_ = 0;       // the first sample that is not before the last requested time
};

}  // namespace

Result<void> complete(NodeTrack& track) {
  if (track.stamps.empty()) return {};
  if (track.acceleration.empty()) return Failure(Error{"", 0, "nodes with acceleration", "none"});
  if (track.orientation.empty() && (track.angular_velocity.empty() || !track.gravity)) {
    return Failure(Error{"", 0,
                         "nodes with orientation, or with angular velocity and gravity in the "
                         "acceleration",
                         "neither"});
  }
  if (track.orientation.empty()) make_orientation(track);
  if (track.angular_velocity.empty()) make_angular_velocity(track);
  return {};
}

WornFrames lost_nodes(std::size_t frames, std::size_t nodes) {
  WornFrames out;
  out.nodes = nodes;
  out.orientation.resize(frames * nodes * 4);
  out.acceleration.resize(frames * nodes * 3);
  out.angular_velocity.resize(frames * nodes * 3);
  out.valid.resize(frames * nodes);
  return out;
}

void put_node(const NodeTrack& track, const EvenSpan& grid, double rate_hz, std::size_t node,
              WornFrames& out) {
  NodeCurve curve(track);
  for (std::size_t t = 0; t < grid.frames; ++t) {
    curve.put(grid_stamp(grid.start, rate_hz, t), t * out.nodes + node, rate_hz, out);
  }
}

Result<EvenNodes> even_nodes(const std::vector<NodeTrack>& tracks, double rate_hz,
                             std::optional<EvenSpan> span) {
  const std::vector<Time>& root = tracks.back().stamps;
  if (root.size() < 2) {
    return Failure(
        Error{"", 0, "at least two samples of the root's node", std::to_string(root.size())});
  }
  const double steps = seconds_between(root.front(), root.back()) * rate_hz;
  if (steps >= most_node_frames) {
    return Failure(Error{"", 0, "at most 10,000,000 frames", std::to_string(steps)});
  }
  const EvenSpan grid = span ? *span : EvenSpan{root.front(), static_cast<std::size_t>(steps) + 1};
  EvenNodes out{lost_nodes(grid.frames, tracks.size()), grid.start};
  for (std::size_t n = 0; n < tracks.size(); ++n) put_node(tracks[n], grid, rate_hz, n, out.worn);
  return out;
}

}  // namespace kinalign
