// SPDX-License-Identifier: Apache-2.0
// Two simulated Kinects before one body that stands, steps, or walks and turns: what each says held
// against the other, as it was measured on KinectMultiTrack.
#pragma once

#include "kinalign/core/error.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinalign {

inline constexpr std::size_t rigs = 3;       // 0, 45, 90 degrees
inline constexpr std::size_t scenarios = 3;  // stand, step, walk_turn
inline constexpr double scenario_s = 30.0;

struct CameraFigures {
  std::array<std::array<double, rigs>, scenarios> rms{};  // cm, own rigid fit over 25 joints
  double far_arm = 0.0;                      // share > 15 cm of far elbow and wrist, 90, step
  std::array<double, rigs> exchanged{};      // share of frames, whole body, all scenarios
  std::array<double, scenarios> thigh_sd{};  // % of its length, frontal
};

/// Of one person, all draws from one seed.
Result<CameraFigures> camera_figures(std::uint64_t seed);

/// The median of each over seeds first … first + count - 1, side by side on `jobs` threads.
Result<CameraFigures> median_camera_figures(std::uint64_t first, std::size_t count,
                                            std::size_t jobs);

struct StampFigures {
  double mean_ms = 0.0, sd_ms = 0.0;  // of steps of one frame
};
StampFigures stamp_figures(std::uint64_t seed);

}  // namespace kinalign
