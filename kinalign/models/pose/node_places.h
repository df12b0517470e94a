// SPDX-License-Identifier: Apache-2.0
// The places of nodes on a body, for models of poses. Each place states the bone that carries the
// node and the bone's direction in a T-pose. It also states the directions of the node's axes, if
// the node is worn as docs/pose.md says.
#pragma once

#include "kinalign/models/pose/pose_body.h"
#include "kinalign/models/pose/pose_features.h"
#include "kinalign/motion/arrays.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A place on the body. Directions are for a person in a T-pose who faces +z: x to the left, y up.
struct WornPlace {
  std::string_view name;         // "wrist_left"
  std::string_view bone;         // a joint of pose_body.h; the bone begins there
  std::array<double, 3> t_pose;  // the bone's direction; zeros: the bone's rotation is the identity
  std::array<double, 3> along;   // direction of the node's x axis
  std::array<double, 3> outward;  // direction of the node's z axis
  bool on_arm = false;
};

/// The known places: waist, wrist_left, wrist_right, ankle_left, ankle_right, head.
std::span<const WornPlace> worn_places();
/// The place with that name; nullptr if there is none.
const WornPlace* worn_place(std::string_view name);

/// The place that a stream's name for a node means: "LeftLowerLeg", "l_shank" and "ankle left" mean
/// "ankle_left". Empty if the name means no place.
std::string_view place_called(std::string_view name);

/// The index of the name that means `place`. An exact match is preferred to other words for the
/// place.
std::optional<std::size_t> node_at(std::span<const std::string> names, std::string_view place);

/// world_from_node in a T-pose that faces +z, for a node worn as docs/pose.md says.
Quat worn_in_t_pose(const WornPlace& place);

/// Rotations [N] of the bones under layout.nodes in a T-pose that faces +z: the shortest rotation
/// from the bone's direction in `body` to its direction in the T-pose. Fails if the place of a node
/// is not known or the body lacks its bone.
Result<std::vector<Quat>> t_pose_rotations(const PoseLayout& layout, const Skeleton& body);

}  // namespace kinalign
