// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_scene.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double largest_distance = 100.0;  // m; a joint farther away is treated as unknown
constexpr double bustle_s = 0.5;
// Greatest number of frames between two frames whose difference counts as a motion.
constexpr std::int64_t longest_gap = 10;

// Converts the true joints to the camera's space.
void take_truth(const KinectJointsAt& joints_at, const RigidTransform& world_from_kinect,
                KinectScene& scene) {
  const Quat turn = world_from_kinect.rotation.conjugate();
  std::array<double, 3 * kinect_joint_count> world{};
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    joints_at(scene.ticks[t].seconds, world);
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const std::size_t i = t * kinect_joint_count + j;
      const Vec3 p =
          turn * (vec3(std::span<const double>(world), j) - world_from_kinect.translation);
      scene.known[i] = p.norm() < largest_distance ? 1 : 0;
      if (scene.known[i] != 0) {
        vec3(scene.truth, i) = p;
      } else if (t > 0) {  // keeps the last position, so that other quantities are not affected
        vec3(scene.truth, i) = vec3(scene.truth, i - kinect_joint_count);
      }
    }
  }
}

/// Computes the heading. The left is the horizontal direction across hips and shoulders. If that
/// direction is not defined, the heading stays as in `before`.
BodyHeading heading(std::span<const double> joints, const Vec3& up, const BodyHeading& before) {
  const Vec3 across = vec3(joints, hip_left) - vec3(joints, hip_right) +
                      vec3(joints, shoulder_left) - vec3(joints, shoulder_right);
  const Vec3 level = across - across.dot(up) * up;
  BodyHeading found = before;
  if (level.norm() > 1e-6) {
    const Vec3 left = level.normalized();
    found.axes.col(0) = left;
    found.axes.col(1) = up;
    found.axes.col(2) = left.cross(up);
  }
  const Vec3 body = vec3(joints, spine_base);
  const Vec3 to_camera = -(body - body.dot(up) * up);
  if (to_camera.norm() > 1e-6) {
    const Vec3 way = to_camera.normalized();
    found.yaw = std::acos(std::clamp(way.dot(found.axes.col(2)), -1.0, 1.0));
    found.left_is_far = way.dot(found.axes.col(0)) < 0.0;
  }
  return found;
}

/// Fills scene.poses.
void take_poses(KinectScene& scene) {
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const std::span<const double> joints = scene.joints(t);
    const Vec3 ground = 0.5 * (vec3(joints, ankle_left) + vec3(joints, ankle_right));
    const Eigen::Matrix3d heading_from_camera = scene.headings[t].axes.transpose();
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const Vec3 from =
          of_torso(static_cast<KinectJoint>(j)) ? ground : Vec3(vec3(joints, spine_base));
      vec3(scene.poses, t * kinect_joint_count + j) =
          heading_from_camera * (vec3(joints, j) - from);
    }
  }
}

/// Returns the speeds of joints at `places` [T,25,3] m: [T,25] m/s.
std::vector<double> speeds(const KinectScene& scene, const std::vector<double>& places) {
  const std::size_t frames = scene.frames();
  std::vector<double> found(scene.known.size(), 0.0);
  for (std::size_t t = 0; t < frames; ++t) {
    // A central difference. At an end or a gap the difference is one-sided.
    const std::size_t a = t > 0 && follows(scene.ticks[t - 1], scene.ticks[t]) ? t - 1 : t;
    const std::size_t b = t + 1 < frames && follows(scene.ticks[t], scene.ticks[t + 1]) ? t + 1 : t;
    const double dt = scene.ticks[b].seconds - scene.ticks[a].seconds;
    if (!(dt > 0.0)) continue;
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const Vec3 way =
          vec3(places, b * kinect_joint_count + j) - vec3(places, a * kinect_joint_count + j);
      found[t * kinect_joint_count + j] = way.norm() / dt;
    }
  }
  return found;
}

/// Returns means of `values` [T,C] over half a second.
std::vector<double> smoothed(const KinectScene& scene, const std::vector<double>& values,
                             std::size_t channels) {
  const std::size_t frames = scene.frames();
  std::vector<double> found(values.size());
  std::vector<double> sum(channels, 0.0);
  std::size_t a = 0, b = 0;
  const auto add = [&](std::size_t t, double sign) {
    for (std::size_t c = 0; c < channels; ++c) sum[c] += sign * values[t * channels + c];
  };
  for (std::size_t t = 0; t < frames; ++t) {
    const double now = scene.ticks[t].seconds;
    for (; scene.ticks[a].seconds < now - bustle_s / 2.0; ++a) add(a, -1.0);
    for (; b < frames && scene.ticks[b].seconds <= now + bustle_s / 2.0; ++b) add(b, 1.0);
    for (std::size_t c = 0; c < channels; ++c) {
      found[t * channels + c] = std::max(0.0, sum[c]) / static_cast<double>(b - a);
    }
  }
  return found;
}

// Returns the means over the 25 joints of each frame.
std::vector<double> over_joints(const std::vector<double>& values) {
  std::vector<double> means(values.size() / kinect_joint_count, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    means[i / kinect_joint_count] += values[i] / kinect_joint_count;
  }
  return means;
}

}  // namespace

bool follows(const KinectTick& before, const KinectTick& after) {
  return after.number - before.number <= longest_gap;
}

KinectScene kinect_scene(const KinectJointsAt& joints_at, std::span<const KinectTick> ticks,
                         const KinectOptions& options) {
  const std::size_t points = ticks.size() * kinect_joint_count;
  KinectScene scene{ticks,
                    std::vector<double>(3 * points),
                    std::vector<std::uint8_t>(points),
                    std::vector<BodyHeading>(ticks.size()),
                    {},
                    {},
                    std::vector<double>(3 * points),
                    {}};
  take_truth(joints_at, options.world_from_kinect, scene);
  const Vec3 up = options.world_from_kinect.rotation.conjugate() * Vec3::UnitY();
  BodyHeading last;
  for (std::size_t t = 0; t < ticks.size(); ++t) {
    const std::span<const double> joints(&scene.truth[3 * kinect_joint_count * t],
                                         3 * kinect_joint_count);
    last = scene.headings[t] = heading(joints, up, last);
  }
  take_poses(scene);
  scene.speeds = speeds(scene, scene.truth);
  scene.bustle = smoothed(scene, over_joints(scene.speeds), 1);
  scene.stir = smoothed(scene, speeds(scene, scene.poses), kinect_joint_count);
  return scene;
}

}  // namespace kinalign
