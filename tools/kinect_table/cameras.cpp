// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/cameras.h"

#include "kinalign/core/parallel.h"
#include "kinalign/motion/kinect_map.h"
#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/person/built_in_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace kinalign {

namespace {

constexpr double distance_m = 2.7, height_m = 1.0;
constexpr double pair_s = 0.02;  // s; frames further apart are no pair
// M; left and right are exchanged if the distance is above this.
constexpr double exchange_m = 0.12;
constexpr double exchange_gain = 0.6;  // and falls to less than this share when they are exchanged
constexpr double far_m = 0.15;

/// A camera that looks at the origin from `degrees` to the person's right of the front.
RigidTransform world_from_kinect(double degrees) {
  const double angle = -degrees * std::numbers::pi / 180.0;
  const Quat around(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  const Quat facing(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitY()));
  return {around * facing, around * Vec3(0.0, height_m, distance_m)};
}

Result<KinectJointsAt> joints_of(Piece piece, std::uint64_t seed) {
  BuiltInOptions options;
  options.programme = {{piece, scenario_s}};
  options.seed = seed;
  const Motion motion = KA_TRY(built_in_motion(options));
  const KinectMap map = KA_TRY(kinect_map(motion.skeleton));
  return KinectJointsAt([motion, map](double t, std::span<double> joints) {
    Pose pose;
    GlobalPose global;
    motion.pose_at(t, pose);
    forward_kinematics(motion.skeleton, pose, global);
    kinect_positions(map, global, joints);
  });
}

/// The frames that a camera saw, in the world of the motion.
struct Seen {
  std::vector<KinectTick> ticks;
  PointFrames frames;
};

Seen seen_from(double degrees, const KinectJointsAt& joints_at, const KinectIds& ids) {
  KinectOptions options;
  options.world_from_kinect = world_from_kinect(degrees);
  Seen seen{kinect_ticks(options, ids, 0.0, scenario_s), {}};
  seen.frames = simulate_kinect(joints_at, seen.ticks, options, ids);
  for (std::size_t i = 0; i < seen.frames.state.size(); ++i) {
    vec3(seen.frames.positions, i) =
        options.world_from_kinect * Vec3(vec3(seen.frames.positions, i));
  }
  return seen;
}

struct Pair {
  std::size_t side, front;  // index of the frame in each camera
};

std::vector<Pair> pairs(const Seen& side, const Seen& front) {
  std::vector<Pair> found;
  std::size_t s = 0;
  for (std::size_t f = 0; f < front.ticks.size(); ++f) {
    const auto apart = [&](std::size_t i) {
      return std::abs(side.ticks[i].seconds - front.ticks[f].seconds);
    };
    while (s + 1 < side.ticks.size() && apart(s + 1) <= apart(s)) ++s;
    if (!side.ticks.empty() && apart(s) < pair_s) found.push_back({s, f});
  }
  return found;
}

struct JointPair {
  Vec3 side, front;
};

std::optional<JointPair> joint_pair(const Seen& side, const Seen& front, const Pair& pair,
                                    std::size_t side_joint, std::size_t front_joint) {
  const std::size_t s = pair.side * kinect_joint_count + side_joint;
  const std::size_t f = pair.front * kinect_joint_count + front_joint;
  if (side.frames.state[s] == Tracking::missing || front.frames.state[f] == Tracking::missing) {
    return std::nullopt;
  }
  return JointPair{vec3(side.frames.positions, s), vec3(front.frames.positions, f)};
}

struct Fitted {
  double rms_m = 0.0, far_arm = 0.0;
};

Result<Fitted> fitted(const Seen& side, const Seen& front) {
  const std::vector<Pair> both = pairs(side, front);
  PairMoments moments;
  for (const Pair& pair : both) {
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      if (const auto p = joint_pair(side, front, pair, j, j)) moments.add(p->side, p->front);
    }
  }
  const RigidTransform front_from_side = KA_TRY(fit_rigid(moments));
  double square = 0.0, count = 0.0, far = 0.0, arm = 0.0;
  for (const Pair& pair : both) {
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const auto p = joint_pair(side, front, pair, j, j);
      if (!p) continue;
      const double distance = (front_from_side * p->side - p->front).norm();
      square += distance * distance;
      count += 1.0;
      if (j != elbow_left && j != wrist_left) continue;
      arm += 1.0;
      if (distance > far_m) far += 1.0;
    }
  }
  return Fitted{std::sqrt(square / std::max(count, 1.0)), far / std::max(arm, 1.0)};
}

/// The share of frames in which exchanging left and right brings the two bodies much nearer
/// together.
double exchanged_share(const Seen& side, const Seen& front) {
  double exchanged = 0.0;
  const std::vector<Pair> both = pairs(side, front);
  for (const Pair& pair : both) {
    double as_said = 0.0, swapped = 0.0, count = 0.0;
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      if (kinect_limbs[j].side == KinectSide::middle) continue;
      const auto said = joint_pair(side, front, pair, j, j);
      const auto other = joint_pair(side, front, pair, kinect_limbs[j].partner, j);
      if (!said || !other) continue;
      as_said += (said->side - said->front).norm();
      swapped += (other->side - other->front).norm();
      count += 1.0;
    }
    if (count > 0.0 && as_said / count > exchange_m && swapped < exchange_gain * as_said) {
      exchanged += 1.0;
    }
  }
  return exchanged / std::max<double>(static_cast<double>(both.size()), 1.0);
}

/// Standard deviation of the thighs' length in percent of the length, mean of both.
double thigh_sd(const Seen& seen) {
  double percent = 0.0;
  for (const auto& [hip, knee] : {std::pair{hip_left, knee_left}, {hip_right, knee_right}}) {
    double sum = 0.0, square = 0.0, count = 0.0;
    for (std::size_t t = 0; t < seen.ticks.size(); ++t) {
      const std::size_t i = t * kinect_joint_count;
      if (seen.frames.state[i + hip] == Tracking::missing ||
          seen.frames.state[i + knee] == Tracking::missing) {
        continue;
      }
      const double length =
          (vec3(seen.frames.positions, i + hip) - vec3(seen.frames.positions, i + knee)).norm();
      sum += length;
      square += length * length;
      count += 1.0;
    }
    if (count < 2.0) continue;
    const double mean = sum / count;
    percent += 50.0 * std::sqrt(std::max(0.0, square / count - mean * mean)) / mean;
  }
  return percent;
}

constexpr std::array<Piece, scenarios> pieces_shown{Piece::stand, Piece::step, Piece::walk_turn};

double middle(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

Result<CameraFigures> camera_figures(std::uint64_t seed) {
  CameraFigures figures;
  for (std::size_t s = 0; s < scenarios; ++s) {
    const KinectJointsAt joints_at = KA_TRY(joints_of(pieces_shown[s], seed));
    KinectIds ids{.seed = seed, .person = seed, .take = s, .camera = 100};
    const Seen front = seen_from(0.0, joints_at, ids);
    figures.thigh_sd[s] = thigh_sd(front);
    for (std::size_t r = 0; r < rigs; ++r) {
      ids.camera = r;
      const Seen side = seen_from(45.0 * static_cast<double>(r), joints_at, ids);
      const Fitted fit = KA_TRY(fitted(side, front));
      figures.rms[s][r] = 100.0 * fit.rms_m;
      if (s == 1 && r == 2) figures.far_arm = fit.far_arm;
      figures.exchanged[r] += exchanged_share(side, front) / static_cast<double>(scenarios);
    }
  }
  return figures;
}

Result<CameraFigures> median_camera_figures(std::uint64_t first, std::size_t count,
                                            std::size_t jobs) {
  std::vector<Result<CameraFigures>> all(count);
  parallel_for(count, jobs, [&](std::size_t i) { all[i] = camera_figures(first + i); });
  const auto median = [&](const auto& pick) {
    std::vector<double> values;
    values.reserve(all.size());
    for (const auto& one : all) values.push_back(pick(*one));
    return middle(values);
  };
  for (auto& one : all) {
    if (!one) return Failure(one.error());
  }
  CameraFigures out;
  for (std::size_t s = 0; s < scenarios; ++s) {
    out.thigh_sd[s] = median([&](const CameraFigures& f) { return f.thigh_sd[s]; });
    for (std::size_t r = 0; r < rigs; ++r) {
      out.rms[s][r] = median([&](const CameraFigures& f) { return f.rms[s][r]; });
    }
  }
  out.far_arm = median([](const CameraFigures& f) { return f.far_arm; });
  // These events are rare, so the mean is taken, not the median.
  for (std::size_t r = 0; r < rigs; ++r) {
    for (const auto& one : all) {
      out.exchanged[r] += one->exchanged[r] / static_cast<double>(count);
    }
  }
  return out;
}

StampFigures stamp_figures(std::uint64_t seed) {
  const auto ticks = kinect_ticks({}, {.seed = seed}, 0.0, 600.0);
  double sum = 0.0, square = 0.0, count = 0.0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    if (ticks[i].number - ticks[i - 1].number != 1) continue;
    const double step = 1e-4 * static_cast<double>(ticks[i].device - ticks[i - 1].device);
    sum += step;
    square += step * step;
    count += 1.0;
  }
  const double mean = sum / std::max(count, 1.0);
  return {mean, std::sqrt(std::max(0.0, square / std::max(count, 1.0) - mean * mean))};
}

}  // namespace kinalign
