// SPDX-License-Identifier: Apache-2.0
// A moving body with the joints of a Kinect.
#pragma once

#include "kinalign/models/joint_frames.h"
#include "kinalign/motion/kinect_joints.h"

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace kinalign {

/// The first 20 joints of a Kinect and SpineShoulder: a body without finger tips.
inline std::vector<std::string> body_joint_names() {
  return {kinect_joints.begin(), kinect_joints.begin() + 21};
}

/// A standing person who faces +z, in the order of kinect_joints; x points to the person's left.
inline constexpr std::array<std::array<float, 3>, 21> standing_body{
    {{0.00F, 0.95F, 0.00F},  {0.00F, 1.20F, 0.00F},  {0.00F, 1.50F, 0.02F},  {0.00F, 1.65F, 0.04F},
     {0.18F, 1.40F, 0.00F},  {0.24F, 1.12F, 0.02F},  {0.26F, 0.88F, 0.06F},  {0.27F, 0.80F, 0.08F},
     {-0.18F, 1.40F, 0.00F}, {-0.24F, 1.12F, 0.02F}, {-0.26F, 0.88F, 0.06F}, {-0.27F, 0.80F, 0.08F},
     {0.10F, 0.92F, 0.00F},  {0.11F, 0.50F, 0.02F},  {0.11F, 0.09F, 0.00F},  {0.11F, 0.04F, 0.12F},
     {-0.10F, 0.92F, 0.00F}, {-0.11F, 0.50F, 0.02F}, {-0.11F, 0.09F, 0.00F}, {-0.11F, 0.04F, 0.12F},
     {0.00F, 1.42F, 0.00F}}};

/// `frames` of the standing body, each joint moved by up to 5 cm along a slow wave of its own.
inline JointFrames moving_body(std::size_t frames, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> turn(0.0, 6.28);
  JointFrames out{standing_body.size(), {}, {}};
  std::vector<double> phases(3 * standing_body.size());
  for (double& phase : phases) phase = turn(random);
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t i = 0; i < phases.size(); ++i) {
      const double wave = 0.05 * std::sin(phases[i] + 0.1 * static_cast<double>(t));
      out.positions.push_back(standing_body[i / 3][i % 3] + static_cast<float>(wave));
    }
  }
  out.seen.assign(frames * standing_body.size(), 2);
  return out;
}

/// Every position turned about the vertical by `angle` and moved.
inline void turn_and_move(std::vector<float>& positions, double angle,
                          const std::array<float, 3>& move) {
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const float x = positions[i], z = positions[i + 2];
    positions[i] = c * x + s * z + move[0];
    positions[i + 1] += move[1];
    positions[i + 2] = c * z - s * x + move[2];
  }
}

}  // namespace kinalign
