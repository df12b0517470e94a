// SPDX-License-Identifier: Apache-2.0
// The 25 joints of Kinect v2 in the SDK's order (JointType), and their parents.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kinalign {

constexpr std::array<std::string_view, 25> kinect_joints{
    "SpineBase",     "SpineMid",    "Neck",      "Head",          "ShoulderLeft",
    "ElbowLeft",     "WristLeft",   "HandLeft",  "ShoulderRight", "ElbowRight",
    "WristRight",    "HandRight",   "HipLeft",   "KneeLeft",      "AnkleLeft",
    "FootLeft",      "HipRight",    "KneeRight", "AnkleRight",    "FootRight",
    "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight",  "ThumbRight"};

/// The parent of the root is the root itself.
constexpr std::array<std::size_t, 25> kinect_parents{0,  0,  20, 2, 20, 4,  5,  6, 20, 8, 9,  10, 0,
                                                     12, 13, 14, 0, 16, 17, 18, 1, 7,  7, 11, 11};

}  // namespace kinalign
