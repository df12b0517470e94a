// SPDX-License-Identifier: Apache-2.0
// Estimates the heading error of each node from a Kinect that sees the bone which carries the node.
// A node knows the vertical; its heading is unknown at first and drifts. If a bone is not vertical,
// its direction in the Kinect's data shows the heading error. That direction comes from the
// Kinect's joints alone, or from these joints and the pose that a model estimates from them. The
// pose helps: a Kinect puts an elbow 5 cm off, which turns a forearm by 10 degrees, and the model
// corrects a part of that.
//
// Each node has an extended Kalman filter of four numbers: the heading error and the rotation of
// the node on its bone. A measurement is the bone's direction. Whole sequences are then smoothed
// backwards (Rauch, Tung, Striebel, AIAA J. 3(8), 1965).
#pragma once

#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/models/fuse/seen_bones.h"

#include <Eigen/Core>

#include <vector>

namespace kinalign {

struct HeadingOptions {
  double heading_deg = 20.0;  // spread of the heading before any measurement, 1 sigma
  double mount_deg = 5.0;     // spread of the mounting about each axis, 1 sigma
  /// Random walk of the heading: after m minutes this times sqrt(m).
  double walk_deg_per_minute = 3.0;
  /// Spread of a direction seen by the Kinect, 1 sigma.
  double tracked_deg = 6.0, inferred_deg = 25.0;
  /// A Kinect's error lasts for about a third of a second (docs/kinect_noise.md), so this many
  /// measurements count as one.
  double frames_as_one = 20.0;
  /// Sigma; a larger error is taken for swapped sides or an occlusion and ignored.
  double gate = 3.0;
};

/// A node and the bone of the body that carries it. The root is no such bone.
struct CarriedBone {
  std::size_t node = 0, bone = 0;
};
std::vector<CarriedBone> carried_bones(const FuseLayout& layout, const PoseBody& body);

/// Turns each bone whose node is valid in frame `t` three quarters of the way to the node's
/// rotation. `nodes`: with corrected headings. `root`: in the world. `rotations` [B]: relative to
/// the root.
void turn_to_nodes(std::span<const CarriedBone> carried, const NodeFrames& nodes, std::size_t t,
                   const Eigen::Quaternionf& root, std::span<Turn> rotations);

/// The estimate for one node in one frame.
struct HeadingState {
  /// Rad; Y(yaw) q M is the bone's rotation in the world, q the node's orientation.
  float yaw = 0.0F;
  float spread = 0.0F;                              // rad, 1 sigma of yaw
  Eigen::Vector3f mount = Eigen::Vector3f::Zero();  // rad; M is the rotation by this vector
};

/// The corrected orientation of a node's bone.
Eigen::Quaternionf corrected(const HeadingState& state, const Eigen::Quaternionf& orientation);

/// The causal filter: takes frames in order and uses no later frames.
class HeadingFilter {
 public:
  /// `body`: gives the axes of the bones. A node whose bone the Kinect does not see (head) keeps
  /// its initial state. `layout` must live longer than the filter.
  HeadingFilter(const FuseLayout& layout, const PoseBody& body, HeadingOptions options = {});

  /// Takes frame `t` of `nodes`, and the direction of each node's bone [N] in the world.
  void step(const NodeFrames& nodes, std::size_t t,
            std::span<const std::optional<SeenDirection>> directions);
  /// For each node [N] the bone that the Kinect sees; empty if it sees none.
  std::vector<std::optional<SeenBone>> bones() const;
  HeadingState state(std::size_t node) const;
  void reset();

 private:
  friend class HeadingSmoother;
  using State = Eigen::Matrix<double, 4, 1>;
  using Spread = Eigen::Matrix<double, 4, 4>;
  struct Filter {
    std::optional<SeenBone> bone;
    State mean = State::Zero();
    Spread spread = Spread::Zero();
  };
  void predict(Filter& filter) const;
  void measure(Filter& filter, const Eigen::Quaternionf& orientation,
               const SeenDirection& seen) const;

  const FuseLayout* layout_;
  HeadingOptions options_;
  std::vector<Filter> filters_;  // [N] one filter for each node
};

/// Directions of the nodes' bones [T,N]; empty if not seen.
using NodeDirections = std::vector<std::optional<SeenDirection>>;

/// Directions from the Kinect's joints alone.
NodeDirections directions_of_joints(const HeadingFilter& filter, const JointFrames& kinect);
/// The mean of two directions, if the Kinect sees the bone: the one between the Kinect's joints,
/// and the one in a pose. Their errors differ, and each direction alone is worse
/// (docs/models_nodes.md). `rotations` [T,B]: relative to the root. `root` [T]: in the world.
NodeDirections directions_of_pose(const HeadingFilter& filter, const JointFrames& kinect,
                                  std::span<const Turn> rotations,
                                  std::span<const Eigen::Quaternionf> root);

/// The state of each node in each frame [T,N], estimated from all frames, earlier and later ones.
std::vector<HeadingState> node_headings(HeadingFilter filter, const NodeFrames& nodes,
                                        const NodeDirections& directions);

/// The rotation about the vertical, rad, from the world of all nodes to the Kinect's world. It is
/// the median difference between two headings: that of hips and shoulders, and that of the root's
/// node. Empty if both are seen together for less than a second. The filters start from this value,
/// although the headings of single nodes may differ from it.
std::optional<double> shared_heading(const FuseLayout& layout, const FuseInput& input);
/// Rotates the world of all nodes about the vertical by `yaw`, rad.
void turn_world(NodeFrames& nodes, double yaw);

/// The nodes with corrected orientations and accelerations. Angular velocities are rotated by the
/// mounting.
NodeFrames with_headings(NodeFrames nodes, const std::vector<HeadingState>& states);

}  // namespace kinalign
