// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/kinect/kinect_white.h"

#include "kinalign/simulate/kinect/kinect_draws.h"
#include "kinalign/simulate/kinect/kinect_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr double of_robust = 0.75;   // converts figures that were measured on second differences
constexpr double most_white = 0.08;  // m

// Twitches. The measured autocorrelation falls by 5 % (trunk) to 24 % (feet) within one frame,
// although the usual second difference is below a millimetre. A few frames must therefore have
// large errors. The rate of twitches was fitted to each joint's autocorrelation at one frame.
// twitch_rate is per frame; twitch_at_rest is the share of that rate at rest.
constexpr double twitch_rate = 0.0115, twitch_at_rest = 0.02;
constexpr double twitch_sd = 0.025;  // m for each axis, times an exponential draw
constexpr int longest_twitch = 4;    // greatest number of frames of a twitch

struct Twitch {
  int left = 0;  // remaining frames of the twitch
  Vec3 offset = Vec3::Zero();
};

}  // namespace

void add_twitches(const KinectScene& scene, const KinectIds& ids, std::span<double> joints) {
  const RandomStream random = kinect_stream(KinectDraw::twitches, ids);
  std::array<Twitch, kinect_joint_count> twitches{};
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const auto k = static_cast<std::uint64_t>(scene.ticks[t].number) * kinect_joint_count + j;
      const double stir = scene.stir[t * kinect_joint_count + j];
      const double moved = twitch_at_rest + std::min(stir, full_stir) / full_stir;
      Twitch& twitch = twitches[j];
      if (twitch.left == 0 &&
          random.chance(k, 0, kinect_joint_noise()[j].twitch * twitch_rate * moved)) {
        twitch.left = 1 + static_cast<int>(longest_twitch * random.uniform(k, 1));
        twitch.offset = twitch_sd * random.exponential(k, 8, 1.0) *
                        Vec3(random.normal(k, 2), random.normal(k, 4), random.normal(k, 6));
      }
      if (twitch.left == 0) continue;
      --twitch.left;
      vec3(joints, t * kinect_joint_count + j) += twitch.offset;
    }
  }
}

double student_t(double degrees, double u, double v) {
  return std::sqrt(degrees * (std::pow(u, -2.0 / degrees) - 1.0)) *
         std::cos(2.0 * std::numbers::pi * v);
}

void add_white_noise(const KinectScene& scene, const KinectIds& ids, std::span<double> joints) {
  const RandomStream random = kinect_stream(KinectDraw::white, ids);
  for (std::size_t t = 0; t < scene.frames(); ++t) {
    const auto k = static_cast<std::uint64_t>(scene.ticks[t].number) * kinect_joint_count;
    for (std::size_t j = 0; j < kinect_joint_count; ++j) {
      const KinectJointNoise& noise = kinect_joint_noise()[j];
      const std::size_t i = t * kinect_joint_count + j;
      const double size = of_robust * (noise.white + noise.white_speed * scene.speeds[i] +
                                       noise.white_stir * scene.stir[i]);
      for (std::size_t a = 0; a < 3; ++a) {
        const double draw = size * student_t(noise.tail, random.uniform(k + j, 2 * a),
                                             random.uniform(k + j, 2 * a + 1));
        joints[3 * i + a] += std::clamp(draw, -most_white, most_white);
      }
    }
  }
}

}  // namespace kinalign
