// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/models/joint_frames.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// m: thigh and shank of the person whom a Kinect shows, by the medians of all bones of which both
/// ends are tracked, against those of UI-PRMD's seven people (Kinect v2). A Kinect shows thighs and
/// upper arms up to a sixth too short, in each person otherwise; all bones in sum tell a person's
/// size with a deviation of 1.4 %, while people differ by 4.6 %. None where bones of half a body
/// are not tracked in 30 frames.
std::optional<double> legs_by_kinect(const std::vector<std::string>& joints,
                                     const JointFrames& kinect);

}  // namespace kinalign
