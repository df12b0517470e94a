// SPDX-License-Identifier: Apache-2.0
// Two simulated Kinects before one body that stands, steps, or walks and turns: their data are
// compared with each other, as was done for KinectMultiTrack.
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
  /// Share of the far elbow and wrist that is off by more than 15 cm, at 90 degrees, step.
  double far_arm = 0.0;
  std::array<double, rigs> exchanged{};  // share of frames, whole body, all scenarios
  /// Standard deviation in % of the length, frontal camera.
  std::array<double, scenarios> thigh_sd{};
};

/// The figures for one person; all random draws come from one seed.
Result<CameraFigures> camera_figures(std::uint64_t seed);

/// The median of each over seeds first … first + count - 1, side by side on `jobs` threads.
Result<CameraFigures> median_camera_figures(std::uint64_t first, std::size_t count,
                                            std::size_t jobs);

struct StampFigures {
  double mean_ms = 0.0, sd_ms = 0.0;  // steps between neighbouring frames
};
StampFigures stamp_figures(std::uint64_t seed);

}  // namespace kinalign
