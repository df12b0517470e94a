// SPDX-License-Identifier: Apache-2.0
// From nodes as they are worn to nodes on bones, by a T-pose. A node on a bone obeys
//
//   bone(t) = Y q(t) M
//
// with q world_from_node as the node says it, M node_from_bone, how it is worn, and Y the heading
// of the node's world against the person's, a turn about the vertical. In a T-pose bone is known:
// it gives M for each Y. It says nothing of Y, and a wrong Y makes a turn forwards one sideways. So
// Y comes from elsewhere:
//   shared    All nodes have one heading: they have a magnetometer, or were reset together. Where
//             the person faces in it is seen by nodes that are worn as docs/pose.md says, and else
//             by arms that come down from the T-pose: a left arm turns about -z, a right one about
//             +z.
//   mounting  Each node has a heading of its own, as one without a magnetometer has, and is worn
//             as docs/pose.md says. The direction that its axes have in a T-pose gives Y, as well
//             as it is worn (a turn of the node about the vertical is taken for heading).
// Drift of a heading behind the T-pose is not seen. Sources: models.md 3.2 (Yi et al., «TransPose»,
// SIGGRAPH 2021) and 3.3 (Huang et al., «Deep inertial poser», SIGGRAPH Asia 2018); arms that come
// down are ours.
#pragma once

#include "kinalign/models/pose/node_places.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// Nodes as they are worn, in the arrays of NodeFrames: `orientation` is world_from_node,
/// `acceleration` in the node's world, without gravity, `angular_velocity` in the node's space.
using WornFrames = NodeFrames;

/// A stretch of frames.
struct TPose {
  std::size_t first = 0, count = 0;
};

/// The first second or more, at most three, in which the root's node is valid and no valid node
/// turns faster than 20 deg/s. Nothing where there is none.
std::optional<TPose> first_still(const WornFrames& worn, double rate_hz);
/// A T-pose in which a node turns faster was not held still, deg/s.
inline constexpr double most_turn_deg_s = 30.0;
/// The fastest turn of a valid node in it, deg/s.
double fastest_turn_deg(const WornFrames& worn, const TPose& t_pose);

enum class Headings : std::uint8_t { shared, mounting };

/// Each node's constants; nodes without a valid frame in the T-pose have none and are lost.
struct NodeOnBone {
  Quat heading = Quat::Identity();         // Y, about +y
  Quat node_from_bone = Quat::Identity();  // M
  Vec3 zero = Vec3::Zero();                // m/s2, in the node's space: what is left at rest
  double tilt_deg = 0.0;                   // between up and where up is if it is worn as told
};

enum class Facing : std::uint8_t { mounting, arms };

struct NodeCalibration {
  std::vector<std::optional<NodeOnBone>> nodes;  // [N] of the layout
  Headings headings = Headings::shared;
  Facing facing = Facing::mounting;  // by what the person's heading was found
  double spread_deg = 0.0;    // of the headings that the mountings give: great where none is shared
  bool worn_as_told = false;  // all nodes but those on arms, as far as their tilt shows it
};

/// Beyond this tilt a node is not worn as docs/pose.md says, or its limb is not in a T-pose.
inline constexpr double most_tilt_deg = 40.0;

/// Headings that lie farther apart are not one for all nodes.
inline constexpr double most_shared_deg = 35.0;

struct CalibrationOptions {
  TPose t_pose;
  /// Absent: by the data. If all nodes but those on arms are worn as told, and their headings by
  /// mounting lie more than 35 degrees apart, then mounting, else shared.
  std::optional<Headings> headings{};
  /// By node, world_from_node in a T-pose that faces +z, where it is known better than by
  /// worn_in_t_pose(): a node whose orientation is already its bone's has the identity. Absent: as
  /// docs/pose.md says. Empty: all of them.
  std::vector<std::optional<Quat>> worn{};
};

/// Fails where a node's place is not known, the root has no valid frame in the T-pose, or nothing
/// shows where the person faces.
Result<NodeCalibration> calibrate(const PoseLayout& layout, const Skeleton& body,
                                  const WornFrames& worn, const CalibrationOptions& options);

/// The nodes as a model sees them. A node without constants is not valid. Accelerations beyond 100
/// m/s2 along an axis are cut there.
NodeFrames on_bones(const NodeCalibration& calibration, WornFrames worn);

}  // namespace kinalign
