// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect_coloured.h"

#include "kinalign/simulate/kinect_draws.h"
#include "kinalign/simulate/kinect_noise.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr double cm = 1e-2;
constexpr double slow_tau_s = 1.5;
constexpr double full_bustle = 0.25;  // m/s: the error grows with motion up to here
constexpr double fast_share = 1.02, fast_rest = 0.1 * cm;
constexpr double slow_rest = 0.1 * cm;
constexpr std::int64_t warm_up = 300;  // frames: ten slow time constants and more

// What the pose does to the tracker two cameras see alike: this share of the variance. Without it
// two parallel cameras before a stepping person differ by 5.8 cm instead of 3.3.
constexpr double shared = 0.7;

// A joint's error goes with its pose: the process runs with the joint's own speed and hardly at
// rest. With a clock that runs evenly, joints at rest of a body that moves tremble by 0.7 mm; 0.13
// are measured.
constexpr double rest_rate = 0.15, most_rate = 1.3;
constexpr double full_rate_speed = 0.165;  // m/s
constexpr double with_body = 0.05, feet_with_body = 0.2;

double rate(const KinectJointNoise& noise, double speed, double bustle) {
  const double body = noise.tail < 2.0 ? feet_with_body : with_body;
  const double moving = (1.0 - body) * speed + body * bustle;
  return std::min(rest_rate + moving / full_rate_speed, most_rate);
}

/// One process per joint and axis; draws come down the tree of joints.
class WanderingBody {
 public:
  explicit WanderingBody(const KinectIds& ids)
      : of_body_(kinect_take_stream(KinectDraw::body_noise, ids)),
        of_camera_(kinect_stream(KinectDraw::camera_noise, ids)),
        of_both_(std::sqrt(shared)),
        of_one_(std::sqrt(1.0 - shared)) {}

  /// Asked for each frame in turn, from -warm_up on.
  void step(std::int64_t frame, std::span<const double> speeds, double bustle) {
    const auto k = static_cast<std::uint64_t>(frame + warm_up) * channels;
    for (const KinectJoint j : kinect_tree_order) {
      if (j == neck) continue;
      const KinectJointNoise& noise = kinect_joint_noise()[j];
      const double x = SmoothNoise::per_tau * kinect_frame_s * rate(noise, speeds[j], bustle);
      draw(j, k);
      const SmoothStep fast(x / noise.tau), slow(x / slow_tau_s);
      for (std::size_t i = 3UL * j; i < 3UL * j + 3; ++i) {
        fast.run(fast_[i], draws_[0][i], draws_[1][i]);
        slow.run(slow_[i], draws_[2][i], draws_[3][i]);
      }
    }
  }
  Vec3 fast(std::size_t j) const { return values(fast_, j); }
  Vec3 slow(std::size_t j) const { return values(slow_, j); }

 private:
  static constexpr std::size_t channels = 3 * kinect_joint_count;
  using Noises = std::array<SmoothNoise, channels>;

  static Vec3 values(const Noises& noises, std::size_t j) {
    return {noises[3 * j].value, noises[3 * j + 1].value, noises[3 * j + 2].value};
  }

  void draw(KinectJoint j, std::uint64_t k) {
    const KinectJointNoise& noise = kinect_joint_noise()[j];
    const double own = std::sqrt(1.0 - noise.kinship * noise.kinship);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t i = 3UL * j + a, kin = 3UL * noise.source + a;
      for (std::size_t pair = 0; pair < 2; ++pair) {
        const auto [body_first, body_second] = of_body_.normals(k + i, 2 * pair);
        const auto [camera_first, camera_second] = of_camera_.normals(k + i, 2 * pair);
        const double first = of_both_ * body_first + of_one_ * camera_first;
        const double second = of_both_ * body_second + of_one_ * camera_second;
        draws_[2 * pair][i] = noise.kinship * draws_[2 * pair][kin] + own * first;
        draws_[2 * pair + 1][i] = noise.kinship * draws_[2 * pair + 1][kin] + own * second;
      }
    }
  }

  RandomStream of_body_, of_camera_;
  double of_both_, of_one_;
  std::array<std::array<double, channels>, 4> draws_{};
  Noises fast_{}, slow_{};
};

Vec3 wander(const KinectJointNoise& noise, double bustle, const Vec3& fast, const Vec3& slow) {
  const double moved = std::min(bustle, full_bustle) / full_bustle;
  const Vec3 fast_sd = fast_share * moved * noise.within + Vec3::Constant(fast_rest);
  return fast_sd.cwiseProduct(fast) + slow_rest * slow;
}

}  // namespace

SmoothStep::SmoothStep(double x) : x_(x), keep_(std::exp(-x)) {
  // 1 - A A^T; its first element is 4/3 x^3 for small x, where the difference has no digits.
  const double k2 = keep_ * keep_;
  const double value = x < 1e-3 ? 4.0 / 3.0 * x * x * x : 1.0 - k2 * (1.0 + 2.0 * x + 2.0 * x * x);
  const double both = 2.0 * x * x * k2;
  const double slope = 1.0 - k2 * (1.0 - 2.0 * x + 2.0 * x * x);
  value_first_ = std::sqrt(std::max(value, 0.0));
  slope_first_ = value_first_ > 0.0 ? both / value_first_ : 0.0;
  slope_second_ = std::sqrt(std::max(slope - slope_first_ * slope_first_, 0.0));
}

void add_coloured_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints) {
  WanderingBody body(ids);
  std::int64_t next = -warm_up;
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const std::int64_t number = scene.ticks[t].number;
    const std::span<const double> speeds(&scene.speeds[t * kinect_joint_count], kinect_joint_count);
    const BodyHeading& heading = scene.headings[t];
    // What a long gap made of it nobody can tell from a fresh start.
    if (number - next >= warm_up) body = WanderingBody(ids);
    for (next = std::max(next, number - warm_up); next <= number; ++next)
      body.step(next, speeds, scene.bustle[t]);
    std::array<Vec3, kinect_joint_count> moved;
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      moved[j] = wander(kinect_joint_noise()[j], scene.bustle[t], body.fast(j), body.slow(j));
    }
    moved[neck] = 0.5 * (moved[spine_shoulder] + moved[head]);
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      vec3(joints, t * kinect_joint_count + j) += heading.axes * moved[j];
    }
  }
}

}  // namespace kinalign
