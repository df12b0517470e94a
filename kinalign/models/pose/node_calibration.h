// SPDX-License-Identifier: Apache-2.0
// Calibrates worn nodes by a T-pose: finds the rotation of the bone under each node. A node on a
// bone obeys
//
//   bone(t) = Y q(t) M
//
// with q = world_from_node as measured, M = node_from_bone (how it is worn), and Y = the heading of
// the node's world against the person's, a rotation about the vertical. In a T-pose bone is known,
// which gives M for each Y. The T-pose says nothing about Y, and a wrong Y turns a forward bend
// into a sideways one. So Y comes from elsewhere:
//   shared    All nodes have one heading: they have a magnetometer or were reset together. Nodes
//             worn as docs/pose.md says show the person's heading. Otherwise arms that come down
//             from the T-pose show it: a left arm turns about -z, a right arm about +z.
//   mounting  Each node has its own heading, as without a magnetometer, and is worn as docs/pose.md
//             says. The direction of its axes in the T-pose gives Y. A rotation of the worn node
//             about the vertical is mistaken for heading.
// Drift of a heading after the T-pose is not detected. Sources: Yi et al., «TransPose»,
// SIGGRAPH 2021; Huang et al., «Deep inertial poser», SIGGRAPH Asia 2018.
// The method of arms that come down is our own.
#pragma once

#include "kinalign/models/pose/node_places.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// Nodes as they are worn, in the arrays of NodeFrames: `orientation` is world_from_node,
/// `acceleration` is in the node's world without gravity, `angular_velocity` is in the node's
/// space.
using WornFrames = NodeFrames;

/// A stretch of frames in which the person holds a T-pose.
struct TPose {
  std::size_t first = 0, count = 0;
};

/// The first stretch of 1 to 3 s in which the root's node is valid and no valid node turns faster
/// than 20 deg/s. Empty if there is none.
std::optional<TPose> first_still(const WornFrames& worn, double rate_hz);
/// deg/s. If a node turns faster in a T-pose, the pose was not held still.
inline constexpr double most_turn_deg_s = 30.0;
/// The fastest rotation of a valid node in the T-pose, deg/s.
double fastest_turn_deg(const WornFrames& worn, const TPose& t_pose);

/// How the nodes' headings are found; see the head of this file.
enum class Headings : std::uint8_t { shared, mounting };

/// The constants of one node. A node without a valid frame in the T-pose has none and can't be
/// used.
struct NodeOnBone {
  Quat heading = Quat::Identity();         // Y, about +y
  Quat node_from_bone = Quat::Identity();  // M
  Vec3 zero = Vec3::Zero();  // m/s2, in the node's space: the bias that remains at rest
  /// Angle between measured up and expected up for a node worn as docs/pose.md says.
  double tilt_deg = 0.0;
};

/// The source of the person's heading: the mounting of the nodes, or arms that come down.
enum class Facing : std::uint8_t { mounting, arms };

struct NodeCalibration {
  std::vector<std::optional<NodeOnBone>> nodes;  // [N] of the layout
  Headings headings = Headings::shared;
  Facing facing = Facing::mounting;  // the source of the person's heading
  /// Spread of the headings from the mountings; large if the nodes do not share a heading.
  double spread_deg = 0.0;
  /// True if all nodes except those on arms are worn as docs/pose.md says, as far as their tilt
  /// shows.
  bool worn_as_described = false;
};

/// deg. With a larger tilt a node is not worn as docs/pose.md says, or its limb is not in a T-pose.
inline constexpr double most_tilt_deg = 40.0;

/// deg. If headings are farther apart than this, the nodes do not share one heading.
inline constexpr double most_shared_deg = 35.0;

struct CalibrationOptions {
  TPose t_pose;
  /// Absent: chosen from the data. It is `mounting` if all nodes except those on arms are worn as
  /// docs/pose.md says and their headings by mounting are more than 35 degrees apart; else
  /// `shared`.
  std::optional<Headings> headings{};
  /// For each node its world_from_node in a T-pose that faces +z, if this is known better than by
  /// worn_in_t_pose(). If a node already states the orientation of its bone, it is the identity.
  /// Absent: the node is worn as docs/pose.md says. An empty list: all nodes are worn so.
  std::vector<std::optional<Quat>> worn{};
};

/// Calibrates all nodes. Fails if the place of a node is not known, if the root has no valid frame
/// in the T-pose, or if nothing shows the person's heading.
Result<NodeCalibration> calibrate(const PoseLayout& layout, const Skeleton& body,
                                  const WornFrames& worn, const CalibrationOptions& options);

/// The nodes with the orientations of their bones, as a model needs them. A node without constants
/// becomes not valid. Accelerations are clamped to +-100 m/s2 per axis.
NodeFrames on_bones(const NodeCalibration& calibration, WornFrames worn);

}  // namespace kinalign
