// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/clip_motion.h"

#include "tests/motion/chains.h"
#include "tests/seeds.h"

#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/motion/interpolation/spline.h"
#include "kinalign/motion/rotation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

constexpr ClipMotionOptions exact{.smooth_s = 0.0};

/// One joint that swings about x and z and moves: closed formulas, 60 Hz.
Clip swing(double rate_hz, double length_s) {
  Clip clip;
  clip.skeleton = {{"a"}, {-1}, {Vec3::Zero()}, {}};
  for (int i = 0; i <= static_cast<int>(length_s * rate_hz); ++i) {
    const double t = i / rate_hz;
    clip.frames.stamps.push_back(utc_time(7'000'000'000 + std::llround(t * 1e9)));
    for (const double x : {std::sin(4.0 * t), std::cos(3.0 * t), 0.5 * t}) {
      clip.frames.local_positions.push_back(x);
    }
    clip.frames.local_rotations.resize(4 * clip.frames.stamps.size());
    // Every second quaternion has the other sign, which is the same rotation.
    const Quat q = rotation(Vec3(std::sin(5.0 * t), 0.3, 0.8 * std::cos(2.0 * t)));
    put_quat(clip.frames.local_rotations, static_cast<std::size_t>(i),
             i % 2 == 0 ? q : Quat(-q.coeffs()));
  }
  return clip;
}

}  // namespace

TEST_CASE("without smoothing the motion goes through every frame") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Chain chain = random_chain(1 + random() % 8, 1 + random() % 40, random);
    Clip clip{chain.skeleton, chain.frames};
    std::int64_t at = -5;
    for (Time& stamp : clip.frames.stamps) {
      stamp = utc_time(at);
      at += 5'000'000 + static_cast<std::int64_t>(random() % 100'000'000);
    }
    const auto motion = motion_of(clip, exact);
    REQUIRE(motion);
    const std::size_t joints = clip.skeleton.joints();
    Pose pose;
    for (std::size_t i = 0; i < clip.frames.size(); ++i) {
      motion->pose_at(seconds(clip.frames.stamps[i] - clip.frames.stamps[0]), pose);
      for (std::size_t j = 0; j < joints; ++j) {
        const std::size_t k = i * joints + j;
        CHECK((pose.local_positions[j] - vec3(clip.frames.local_positions, k)).norm() < 1e-12);
        CHECK(angle_between(pose.local_rotations[j], quat(clip.frames.local_rotations, k)) < 1e-12);
      }
    }
    CHECK(motion->length_s == seconds(clip.frames.stamps.back() - clip.frames.stamps.front()));
  }
}

TEST_CASE("between frames it is the natural spline and the rotation spline of the room") {
  const Clip clip = swing(20.0, 3.0);
  const auto motion = motion_of(clip, exact);
  REQUIRE(motion);
  std::vector<double> times, at;
  for (const Time t : clip.frames.stamps) times.push_back(seconds(t - clip.frames.stamps[0]));
  for (double t = 0.0; t < 3.0; t += 0.0137) at.push_back(t);
  std::vector<double> bends(3 * times.size()), positions(3 * at.size()), rotations(4 * at.size());
  const Knots knots{times, clip.frames.local_positions, 3};
  natural_spline(knots, bends);
  spline_at(knots, bends, at, positions);
  rotation_spline_at({times, clip.frames.local_rotations}, at, rotations);
  Pose pose;
  for (std::size_t i = 0; i < at.size(); ++i) {
    motion->pose_at(at[i], pose);
    CHECK((pose.local_positions[0] - vec3(positions, i)).norm() < 1e-12);
    CHECK(angle_between(pose.local_rotations[0], quat(rotations, i)) < 1e-10);
  }
}

TEST_CASE("rates and accelerations do not jump at a frame") {
  const auto motion = motion_of(swing(20.0, 3.0), exact);
  REQUIRE(motion);
  // If the second derivative jumped, third differences would grow as the step shrinks.
  const auto roughest = [&](double h) {
    double worst = 0.0;
    for (int i = 8; i < 50; ++i) {  // around each frame
      const double t = i / 20.0;
      std::array<Pose, 4> p;
      for (std::size_t k = 0; k < 4; ++k) {
        motion->pose_at(t + (static_cast<double>(k) - 1.5) * h, p[k]);
      }
      const auto third = [&](const auto& of) -> double {
        return ((of(p[3]) - of(p[0])) - 3.0 * (of(p[2]) - of(p[1]))).norm() / (h * h * h);
      };
      worst = std::max(worst, third([](const Pose& q) -> Vec3 { return q.local_positions[0]; }));
      worst = std::max(worst, third([](const Pose& q) -> Vec3 {
                         return q.local_rotations[0] * Vec3(0.3, 0.5, 0.7);
                       }));
    }
    return worst;
  };
  CHECK(roughest(1e-3) < 1.5 * roughest(8e-3));
}

TEST_CASE("smoothing takes the noise of a suit and leaves the movement") {
  Clip clip = swing(120.0, 4.0);
  const Clip clean = clip;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (double& x : clip.frames.local_positions) x += 0.001 * normal(random);
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const Quat shaken = quat(clip.frames.local_rotations, i) *
                        rotation(0.002 * Vec3(normal(random), normal(random), normal(random)));
    put_quat(clip.frames.local_rotations, i, shaken);
  }
  const auto rough = motion_of(clip, exact), smooth = motion_of(clip, {.smooth_s = 0.015});
  REQUIRE(rough);
  REQUIRE(smooth);
  const auto misses = [&](const Motion& motion) {  // the largest error away from both ends
    Pose pose;
    std::pair<double, double> worst{0.0, 0.0};
    for (std::size_t i = 10; i + 10 < clean.frames.size(); ++i) {
      motion.pose_at(static_cast<double>(i) / 120.0, pose);
      const double place = (pose.local_positions[0] - vec3(clean.frames.local_positions, i)).norm();
      worst.first = std::max(worst.first, place);
      worst.second = std::max(worst.second, angle_between(pose.local_rotations[0],
                                                          quat(clean.frames.local_rotations, i)));
    }
    return worst;
  };
  // Noise of 0.001 on each axis is up to 0.0038 off in 460 frames. After the mean over about 6
  // frames 0.4 of that is left. The mean also changes the movement itself (at most 16 /s2 of
  // curvature) by 0.015^2 / 2 * 16 = 0.0018.
  CHECK(misses(*rough).first > 0.003);
  CHECK(misses(*smooth).first < 0.003);
  CHECK(misses(*smooth).second < 0.006);
}

TEST_CASE("before the first frame and behind the last the nearest one stands") {
  const Clip clip = swing(20.0, 1.0);
  const auto motion = motion_of(clip, exact);
  REQUIRE(motion);
  Pose pose;
  motion->pose_at(-3.0, pose);
  CHECK(pose.local_positions[0] == vec3(clip.frames.local_positions, 0));
  motion->pose_at(99.0, pose);
  CHECK((pose.local_positions[0] - vec3(clip.frames.local_positions, 20)).norm() < 1e-12);
}

TEST_CASE("what is no motion is refused with what is wrong") {
  const auto message = [](const Clip& clip) {
    const auto motion = motion_of(clip);
    REQUIRE_FALSE(motion);
    return to_string(motion.error());
  };
  CHECK(message({}) == "expected a clip with joints and frames, found 0 joints, 0 frames");
  Clip clip = swing(10.0, 1.0);
  clip.frames.stamps[4] = clip.frames.stamps[3];
  CHECK(message(clip) == "expected rising stamps, found frame 4 does not rise");
  clip = swing(10.0, 1.0);
  clip.frames.local_positions[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(clip) == "expected finite positions and rotations, found NaN or infinity");
  clip = swing(10.0, 1.0);
  clip.frames.local_rotations.pop_back();
  CHECK(
      message(clip) ==
      "expected a position and a rotation for each joint and frame, found arrays of other lengths");
}
