// SPDX-License-Identifier: Apache-2.0
// One vocabulary for the joints that models use: the Kinect's names. Other skeletons are translated
// by name.
#pragma once

#include "kinalign/motion/index_of.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Translates each joint's name to the Kinect's name. Known names: the Kinect's own, UI-PRMD's 22
/// ("Waist", "LowerLegLeft"), and those of usual mocap skeletons ("LeftUpLeg"). An unknown name is
/// kept. Each Kinect name is used once: a second joint at the same place keeps its own name.
std::vector<std::string> kinect_names(const std::vector<std::string>& names);

/// For each of these Kinect joints the index of its nearest ancestor among `names`; -1: none.
std::vector<int> kinect_parents_of(const std::vector<std::string>& names);

}  // namespace kinalign
