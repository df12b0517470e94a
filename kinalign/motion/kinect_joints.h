// SPDX-License-Identifier: Apache-2.0
// The 25 joints of Kinect v2 in the SDK's order (JointType).
#pragma once

#include <array>
#include <string_view>

namespace kinalign {

constexpr std::array<std::string_view, 25> kinect_joints{
    "SpineBase",     "SpineMid",    "Neck",      "Head",          "ShoulderLeft",
    "ElbowLeft",     "WristLeft",   "HandLeft",  "ShoulderRight", "ElbowRight",
    "WristRight",    "HandRight",   "HipLeft",   "KneeLeft",      "AnkleLeft",
    "FootLeft",      "HipRight",    "KneeRight", "AnkleRight",    "FootRight",
    "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight",  "ThumbRight"};

}  // namespace kinalign
