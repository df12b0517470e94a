// SPDX-License-Identifier: Apache-2.0
// Where nodes are worn, for models of poses: the bone each node moves with, how the bone stands in
// a T-pose, and how the node's own axes lie then if it is worn as docs/pose.md says.
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

/// Directions are those of a person in a T-pose who faces +z: x to the left, y up.
struct WornPlace {
  std::string_view name;          // "wrist_left"
  std::string_view bone;          // a joint of pose_body.h; the bone begins there
  std::array<double, 3> t_pose;   // of the bone; zeros: the bone's rotation is the identity
  std::array<double, 3> along;    // of the node's x
  std::array<double, 3> outward;  // of the node's z
  bool on_arm = false;
};

/// waist, wrist_left, wrist_right, ankle_left, ankle_right, head.
std::span<const WornPlace> worn_places();
/// nullptr where no place has that name.
const WornPlace* worn_place(std::string_view name);

/// The place that a stream's name for a node means: "LeftLowerLeg", "l_shank" and "ankle left" are
/// "ankle_left". Empty where it means none.
std::string_view place_called(std::string_view name);

/// Which of `names` is the node at `place`: the name itself comes before other words for it.
std::optional<std::size_t> node_at(std::span<const std::string> names, std::string_view place);

/// world_from_node in a T-pose that faces +z, if the node is worn as docs/pose.md says.
Quat worn_in_t_pose(const WornPlace& place);

/// Rotations [N] of the bones of layout.nodes in a T-pose that faces +z: the shortest turn from the
/// bone's direction in `body` to the one in a T-pose. Fails where a node's place is not known or
/// the body lacks its bone.
Result<std::vector<Quat>> t_pose_rotations(const PoseLayout& layout, const Skeleton& body);

}  // namespace kinalign
