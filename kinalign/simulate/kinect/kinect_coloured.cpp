// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_coloured.h"

#include "kinalign/simulate/kinect/kinect_draws.h"
#include "kinalign/simulate/kinect/kinect_noise.h"
#include "kinalign/simulate/kinect/kinect_pose_error.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

// Sizes in units of the measured standard deviation within a take. Fitted to three figures: the
// standard deviation of each joint, the autocorrelation at 5 and 15 frames, and the part of an
// error that other repetitions predict at the nearest pose.
constexpr double pose_share = 1.3, moving_share = 0.8;
constexpr double at_rest = 0.0014;  // m, for a still body; the length of the thigh varies by 0.6 %
constexpr std::int64_t warm_up = 300;  // number of frames: four time constants of a joint at rest

// Two cameras see the same effect of the pose on the tracker, so these shares of the variance are
// common to both. With independent draws, two parallel cameras in front of a stepping person would
// differ by 5.8 cm; measured are 3.3 cm.
constexpr double pose_shared = 0.9, moving_shared = 0.77;

// The time of the moving part advances with the joint's own speed and almost stops at rest. With
// constant time steps, joints at rest on a moving body would vary by 0.7 mm; measured are 0.13 mm.
constexpr double rest_rate = 0.15, most_rate = 1.3;
constexpr double full_rate_speed = 0.165;  // m/s
constexpr double with_pose = 0.05;

/// Returns the rate of the process's time for a joint's speed and change of pose, m/s.
double rate(double speed, double stir) {
  const double moving = (1.0 - with_pose) * speed + with_pose * stir;
  return std::min(rest_rate + moving / full_rate_speed, most_rate);
}

/// One process for each joint and axis. The draws are correlated along the tree of joints.
class WanderingBody {
 public:
  explicit WanderingBody(const KinectIds& ids)
      : of_body_(kinect_take_stream(KinectDraw::body_noise, ids)),
        of_camera_(kinect_stream(KinectDraw::camera_noise, ids)),
        of_both_(std::sqrt(moving_shared)),
        of_one_(std::sqrt(1.0 - moving_shared)) {}

  /// Call for each frame in order, beginning at -warm_up.
  void step(std::int64_t frame, std::span<const double> speeds, std::span<const double> stir) {
    const auto k = static_cast<std::uint64_t>(frame + warm_up) * channels;
    for (const KinectJoint j : kinect_tree_order) {
      // The neck is computed below, as the mean of its neighbours.
      if (j == neck) continue;
      const KinectJointNoise& noise = kinect_joint_noise()[j];
      const double x = SmoothNoise::per_tau * kinect_frame_s * rate(speeds[j], stir[j]);
      draw(j, k);
      const SmoothStep step(x / noise.tau);
      for (std::size_t i = 3UL * j; i < 3UL * j + 3; ++i) {
        step.run(noises_[i], draws_[0][i], draws_[1][i]);
      }
    }
  }
  Vec3 at(std::size_t j) const {
    return {noises_[3 * j].value(), noises_[3 * j + 1].value(), noises_[3 * j + 2].value()};
  }

 private:
  static constexpr std::size_t channels = 3 * kinect_joint_count;

  /// Draws the numbers for joint j. The joint with which it is correlated must be drawn before.
  void draw(KinectJoint j, std::uint64_t k) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const double own = std::sqrt(1.0 - noise.kinship * noise.kinship);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t i = 3UL * j + a, kin = 3UL * noise.source + a;
      const auto [body_first, body_second] = of_body_.normals(k + i, 0);
      const auto [camera_first, camera_second] = of_camera_.normals(k + i, 0);
      draws_[0][i] =
          noise.kinship * draws_[0][kin] + own * (of_both_ * body_first + of_one_ * camera_first);
      draws_[1][i] =
          noise.kinship * draws_[1][kin] + own * (of_both_ * body_second + of_one_ * camera_second);
    }
  }

  RandomStream of_body_, of_camera_;
  double of_both_, of_one_;
  std::array<std::array<double, channels>, 2> draws_{};
  std::array<SmoothNoise, channels> noises_{};
};

/// Returns the size of a take's errors relative to the usual size, log-normal with rms 1. In
/// UI-PRMD, five of 64 takes contain 40 % (feet) to 100 % (spine) of the errors above 10 cm.
std::array<double, kinect_joint_count> take_sizes(const KinectIds& ids) {
  const RandomStream random = kinect_take_stream(KinectDraw::take_size, ids);
  std::array<double, kinect_joint_count> draws{}, sizes{};
  for (const KinectJoint j : kinect_tree_order) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const double kin = noise.source == j ? 0.0 : draws[noise.source];
    const double c = noise.kinship, spread = noise.spread;
    draws[j] = c * kin + std::sqrt(1.0 - c * c) * random.normal(j, 0);
    sizes[j] = std::exp(spread * draws[j] - spread * spread);
  }
  return sizes;
}

}  // namespace

SmoothStep::SmoothStep(double x) {
  // exp(F x) for F = N - 1 with N^3 = 0, and the stationary covariance of the state.
  const Eigen::Matrix3d n{{1.0, 1.0, 0.0}, {0.0, 1.0, 1.0}, {-1.0, -3.0, -2.0}};
  const Eigen::Matrix3d kept{{1.0, 0.0, -1.0 / 3.0}, {0.0, 1.0 / 3.0, 0.0}, {-1.0 / 3.0, 0.0, 1.0}};
  transition_ = std::exp(-x) * (Eigen::Matrix3d::Identity() + x * n + 0.5 * x * x * (n * n));
  const Eigen::Matrix3d fresh = kept - transition_ * kept * transition_.transpose();
  const double bend = std::sqrt(std::max(fresh(2, 2), 1e-12));
  first_ = fresh.col(2) / bend;
  const double slope = std::sqrt(std::max(fresh(1, 1) - first_[1] * first_[1], 1e-18));
  second_ = Vec3((fresh(0, 1) - first_[0] * first_[1]) / slope, slope, 0.0);
}

void add_coloured_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints) {
  WanderingBody body(ids);
  const KinectPoseError of_pose(ids, pose_shared);
  const std::array<double, kinect_joint_count> sizes = take_sizes(ids);
  std::int64_t next = -warm_up;
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const std::int64_t number = scene.ticks[t].number;
    const std::span<const double> speeds(&scene.speeds[t * kinect_joint_count], kinect_joint_count);
    const std::span<const double> stir(&scene.stir[t * kinect_joint_count], kinect_joint_count);
    const BodyHeading& heading = scene.headings[t];
    // After a long gap the process is as different as a new one.
    if (number - next >= warm_up) body = WanderingBody(ids);
    for (next = std::max(next, number - warm_up); next <= number; ++next)
      body.step(next, speeds, stir);
    const auto posed =
        of_pose.at({&scene.poses[3 * kinect_joint_count * t], 3 * kinect_joint_count});
    std::array<Vec3, kinect_joint_count> moved;
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const double size = moving_share * std::min(stir[j], full_stir) / full_stir;
      const Vec3 within = sizes[j] * kinect_joint_noise()[j].within;
      moved[j] =
          within.cwiseProduct(pose_share * posed[j] + size * body.at(j)) + at_rest * body.at(j);
    }
    moved[neck] = 0.5 * (moved[spine_shoulder] + moved[head]);
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      vec3(joints, t * kinect_joint_count + j) += heading.axes * moved[j];
    }
  }
}

}  // namespace kinalign
