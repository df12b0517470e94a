// SPDX-License-Identifier: Apache-2.0
// Measures of Kinect joints against their truth: the protocol's marks (mean over repetitions) and
// the statistics of the noise. They are the same for real and for simulated joints.
#pragma once

#include "tools/kinect_table/repetitions.h"

#include <span>

namespace kinalign {

/// Rows of the table of within-take noise: left and right together.
inline constexpr std::array<std::string_view, 11> joint_rows{
    "SpineBase", "SpineMid", "SpineShoulder", "Head",  "Shoulder", "Elbow",
    "Wrist",     "Hip",      "Knee",          "Ankle", "Foot"};
inline constexpr std::array<std::size_t, mapped_joints> row_of{0, 1, 2, 3, 4,  5, 6, 4, 5,
                                                               6, 7, 8, 9, 10, 7, 8, 9, 10};

inline constexpr std::array<double, 8> speed_edges{0.0, 0.02, 0.05, 0.1,
                                                   0.2, 0.4,  0.8,  1.6};  // m/s
inline constexpr std::size_t speed_bins = speed_edges.size() - 1;
/// Trunk with shoulders and hips; elbow and wrist; knee; ankle and foot.
inline constexpr std::size_t white_groups = 4;

struct Figures {
  double mpjpe = 0.0, pa = 0.0, bone = 0.0, constancy = 0.0;  // cm
  double acceleration = 0.0, acceleration_smoothed = 0.0;     // mm/frame^2
  double jitter = 0.0;                                        // ratio to the truth's jitter
  std::array<double, mapped_joints> within{};                 // cm, rms of the three axes' sd
  std::array<double, joint_rows.size()> within_row{};         // cm, likewise, both sides
  std::array<double, 3> autocorrelation{};                    // at 1, 5, 15 frames
  std::array<std::array<double, 3>, joint_rows.size()> autocorrelation_row{};
  std::array<std::array<double, speed_bins>, white_groups> white{};  // mm per axis
  std::array<double, joint_rows.size()> far_off{};  // share of residuals above 10 cm
};

Figures figures(const std::vector<Repetition>& pieces);

}  // namespace kinalign
