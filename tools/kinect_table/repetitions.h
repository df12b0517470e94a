// SPDX-License-Identifier: Apache-2.0
// Repetitions of UI-PRMD with their truth, as export_ui_prmd.py writes them.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/simulate/kinect/kinect_body.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kinalign {

inline constexpr std::size_t mapped_joints = 18;

/// The 18 joints that Kinect and Vicon share, in the protocol's order.
inline constexpr std::array<KinectJoint, mapped_joints> mapped{
    spine_base, spine_mid,      spine_shoulder, head,        shoulder_left, elbow_left,
    wrist_left, shoulder_right, elbow_right,    wrist_right, hip_left,      knee_left,
    ankle_left, foot_left,      hip_right,      knee_right,  ankle_right,   foot_right};

/// One repetition: F frames of 30 Hz in one space, x person's left, y up, z towards the camera.
struct Repetition {
  std::uint32_t person = 0, movement = 0, repetition = 0;
  std::size_t frames = 0;
  std::vector<double> kinect, truth;  // [F,18,3] m
  std::vector<std::uint8_t> valid;    // 1: the truth is valid, [F,18]
};

Result<std::vector<Repetition>> read_pieces(std::string_view bytes, std::string_view name);

/// The range of each person's repetitions of a movement: [begin, end) of the list, in its order.
struct TakeRange {
  std::size_t begin = 0, end = 0;
};
std::vector<TakeRange> takes(const std::vector<Repetition>& pieces);

}  // namespace kinalign
