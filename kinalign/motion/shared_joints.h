// SPDX-License-Identifier: Apache-2.0
// The 18 joints that both a Kinect and optical markers give (UI-PRMD's protocol), and the 11 limb
// bones between them. Methods that clean Kinect skeletons are compared on these.
#pragma once

#include "kinalign/core/error.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

inline constexpr std::size_t shared_joint_count = 18;

/// Names of the Kinect SDK, in the order of UI-PRMD's protocol.
inline constexpr std::array<std::string_view, shared_joint_count> shared_joints{
    "SpineBase", "SpineMid",      "SpineShoulder", "Head",       "ShoulderLeft", "ElbowLeft",
    "WristLeft", "ShoulderRight", "ElbowRight",    "WristRight", "HipLeft",      "KneeLeft",
    "AnkleLeft", "FootLeft",      "HipRight",      "KneeRight",  "AnkleRight",   "FootRight"};

/// The joints at these places in UI-PRMD's Kinect files (formats/points/ui_prmd_kinect.h).
inline constexpr std::array<std::string_view, shared_joint_count> shared_joints_in_ui_prmd{
    "Waist",    "Spine",         "Chest",         "HeadTip",       "UpperArmLeft", "ForearmLeft",
    "HandLeft", "UpperArmRight", "ForearmRight",  "HandRight",     "UpperLegLeft", "LowerLegLeft",
    "FootLeft", "ToesLeft",      "UpperLegRight", "LowerLegRight", "FootRight",    "ToesRight"};

/// Two joints as indices into shared_joints.
struct SharedBone {
  std::size_t a = 0, b = 0;
};
/// Arms, legs and the width of the hips.
inline constexpr std::array<SharedBone, 11> limb_bones{{{4, 5},
                                                        {5, 6},
                                                        {7, 8},
                                                        {8, 9},
                                                        {10, 14},
                                                        {10, 11},
                                                        {11, 12},
                                                        {12, 13},
                                                        {14, 15},
                                                        {15, 16},
                                                        {16, 17}}};

/// The index of each shared joint in `joint_names`, which are names of the SDK or of UI-PRMD's
/// Kinect files. Absent if the joint is missing: a suit's skeleton has no tip of the foot.
std::array<std::optional<std::size_t>, shared_joint_count> shared_joints_there(
    std::span<const std::string> joint_names);

/// The same indices, but fails if a joint is missing; the message names the first missing joint.
Result<std::array<std::size_t, shared_joint_count>> shared_joints_among(
    std::span<const std::string> joint_names);

}  // namespace kinalign
