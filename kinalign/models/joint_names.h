// SPDX-License-Identifier: Apache-2.0
// One vocabulary for the joints that models see: a Kinect's. Skeletons that call them otherwise are
// translated by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Each joint's name at a Kinect, where it has one; else the name as it stands. Known are the
/// Kinect's own, UI-PRMD's 22 ("Waist", "LowerLegLeft"), and those of usual mocap skeletons
/// ("LeftUpLeg"). A name comes out once: a second joint of the same place keeps its own.
std::vector<std::string> kinect_names(const std::vector<std::string>& names);

/// Index of what each of these Kinect joints hangs on, among the names; -1: on none of them.
std::vector<int> kinect_parents_of(const std::vector<std::string>& names);

/// Where `name` stands in `names`.
std::optional<std::size_t> index_of(const std::vector<std::string>& names, std::string_view name);

}  // namespace kinalign
