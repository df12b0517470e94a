// SPDX-License-Identifier: Apache-2.0
// The heading of each node's world, found from a Kinect that sees the bone which carries the node.
// A node knows the vertical; its heading is unknown at first and walks. Wherever a bone does not
// hang along the vertical, its direction by the Kinect says how far the heading is off. That
// direction comes from the joints as they are, or from these and a pose that a model answers to
// them: a Kinect puts an elbow 5 cm off, which is 10 degrees of a forearm, and the model knows some
// of it.
//
// For each node an extended Kalman filter of four numbers: the heading's error, and the turn of the
// node on its bone. A measurement is the bone's direction. Whole sequences are smoothed behind it
// (Rauch, Tung, Striebel, AIAA J. 3(8), 1965).
#pragma once

#include "kinalign/models/fuse/fuse_features.h"
#include "kinalign/models/fuse/seen_bones.h"

#include <Eigen/Core>

#include <vector>

namespace kinalign {

struct HeadingOptions {
  double heading_deg = 20.0;         // before anything is seen, 1 sigma
  double mount_deg = 5.0;            // about each axis, 1 sigma
  double walk_deg_per_minute = 3.0;  // of the heading: after m minutes times the root of m
  double tracked_deg = 6.0, inferred_deg = 25.0;  // of a direction that the Kinect sees, 1 sigma
  /// A Kinect's error stays for about a third of a second (docs/kinect_noise.md): so many
  /// measurements count as one.
  double frames_as_one = 20.0;
  double gate = 3.0;  // sigma; a direction farther off is taken for an exchange or an occlusion
};

/// A node, and the bone of the body that carries it, which is not the root.
struct CarriedBone {
  std::size_t node = 0, bone = 0;
};
std::vector<CarriedBone> carried_bones(const FuseLayout& layout, const PoseBody& body);

/// Turns each bone that carries a valid node in frame `t` three quarters of the way to the node's
/// rotation. `nodes`: with corrected headings. `root`: in the world; `rotations` [B] against it.
void turn_to_nodes(std::span<const CarriedBone> carried, const NodeFrames& nodes, std::size_t t,
                   const Eigen::Quaternionf& root, std::span<Turn> rotations);

/// What is known of one node in one frame.
struct HeadingState {
  float yaw = 0.0F;                                 // rad: Y(yaw) q M is the bone in the world
  float spread = 0.0F;                              // rad, 1 sigma of yaw
  Eigen::Vector3f mount = Eigen::Vector3f::Zero();  // rad: M is the turn by this vector
};

/// The corrected orientation of a node's bone.
Eigen::Quaternionf corrected(const HeadingState& state, const Eigen::Quaternionf& orientation);

/// Goes through frames once; without later frames.
class HeadingFilter {
 public:
  /// `body`: of whom the bones' axes are. A node whose bone the Kinect does not see (head) keeps
  /// what it has. `layout` must live longer.
  HeadingFilter(const FuseLayout& layout, const PoseBody& body, HeadingOptions options = {});

  /// Takes frame `t` of `nodes`, and the direction of each node's bone [N] in the world.
  void step(const NodeFrames& nodes, std::size_t t,
            std::span<const std::optional<SeenDirection>> directions);
  /// The way on each node's bone that is seen [N]; none of a node whose bone is not.
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
  std::vector<Filter> filters_;  // [N]
};

/// Directions of the nodes' bones [T,N].
using NodeDirections = std::vector<std::optional<SeenDirection>>;

/// As the Kinect's joints lie.
NodeDirections directions_of_joints(const HeadingFilter& filter, const JointFrames& kinect);
/// Half as the joints lie, half as a pose has them, where the Kinect sees the bone: their errors
/// differ, and each alone is worse (docs/models_nodes.md). `rotations` [T,B] against the root,
/// `root` [T] in the world.
NodeDirections directions_of_pose(const HeadingFilter& filter, const JointFrames& kinect,
                                  std::span<const Turn> rotations,
                                  std::span<const Eigen::Quaternionf> root);

/// For each frame and node [T,N]: by all frames, earlier and later ones.
std::vector<HeadingState> node_headings(HeadingFilter filter, const NodeFrames& nodes,
                                        const NodeDirections& directions);

/// The turn about the vertical, rad, that brings the world of all nodes to the Kinect's: the median
/// of what hips and shoulders show against the root's node. Nothing where both are never seen
/// together for a second. It sets a filter near the truth; nodes may still differ.
std::optional<double> shared_heading(const FuseLayout& layout, const FuseInput& input);
/// All nodes with their world turned about the vertical.
void turn_world(NodeFrames& nodes, double yaw);

/// The nodes with corrected orientations and accelerations; angular velocities turn with the mount.
NodeFrames with_headings(NodeFrames nodes, const std::vector<HeadingState>& states);

}  // namespace kinalign
