// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/shared_joints.h"

#include <algorithm>

namespace kinalign {

namespace {

using Names = std::array<std::string_view, shared_joint_count>;

std::size_t place_of(std::span<const std::string> joint_names, std::string_view name) {
  return static_cast<std::size_t>(std::find(joint_names.begin(), joint_names.end(), name) -
                                  joint_names.begin());
}

/// UI-PRMD's files also have a joint Head, at another place. Only these files have a Waist, which
/// identifies them.
const Names& names_among(std::span<const std::string> joint_names) {
  const bool ui_prmd = place_of(joint_names, "Waist") < joint_names.size();
  return ui_prmd ? shared_joints_in_ui_prmd : shared_joints;
}

}  // namespace

std::array<std::optional<std::size_t>, shared_joint_count> shared_joints_there(
    std::span<const std::string> joint_names) {
  const Names& names = names_among(joint_names);
  std::array<std::optional<std::size_t>, shared_joint_count> places;
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    const std::size_t place = place_of(joint_names, names[j]);
    if (place < joint_names.size()) places[j] = place;
  }
  return places;
}

Result<std::array<std::size_t, shared_joint_count>> shared_joints_among(
    std::span<const std::string> joint_names) {
  const auto there = shared_joints_there(joint_names);
  std::array<std::size_t, shared_joint_count> places{};
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    if (there[j]) {
      places[j] = *there[j];
      continue;
    }
    return Failure(Error{
        "", 0, "a joint " + std::string(names_among(joint_names)[j]) + " among those of a Kinect",
        std::to_string(joint_names.size()) + " others"});
  }
  return places;
}

}  // namespace kinalign
