// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/shared_joints.h"

#include "kinalign/motion/index_of.h"

namespace kinalign {

namespace {

using Names = std::array<std::string_view, shared_joint_count>;

/// UI-PRMD's files also have a joint Head, but at another place. Only these files have a joint
/// Waist, so it identifies them.
const Names& names_among(std::span<const std::string> joint_names) {
  return index_of(joint_names, "Waist") ? shared_joints_in_ui_prmd : shared_joints;
}

}  // namespace

std::array<std::optional<std::size_t>, shared_joint_count> shared_joints_there(
    std::span<const std::string> joint_names) {
  const Names& names = names_among(joint_names);
  std::array<std::optional<std::size_t>, shared_joint_count> places;
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    places[j] = index_of(joint_names, names[j]);
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
