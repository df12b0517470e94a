// SPDX-License-Identifier: Apache-2.0
// Nodes against the bones that they are worn on: angular velocity and acceleration that the mocap's
// poses imply at the node's bone, and its orientation, each after the best constant rotation, since
// nobody knows exactly how a node is strapped on.
#pragma once

#include "kinalign/motion/pose.h"
#include "kinalign/take/take.h"
#include "kinalign/view/page/take_page.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// The bone that a node is worn on: its rotation is `turns`, and the node lies near `place`.
struct WornOn {
  std::size_t turns = 0, place = 0;
};

/// The usual names of nodes and joints decide ("wrist_left", "LeftForeArm"); absent for others.
std::optional<WornOn> worn_on(const std::string& node, const std::vector<std::string>& joints);

/// A node's values as it measured them, whatever the take's space: orientation of the sensor in the
/// node's own world, vectors in the sensor's space.
struct NodeReading {
  bool valid = false;
  Quat orientation = Quat::Identity();
  Vec3 rate = Vec3::Zero(), acceleration = Vec3::Zero();
};

/// Row `row` of a group, its step into the root node's space undone.
std::vector<NodeReading> node_readings(const ImuGroup& group, const ImuRows& rows, std::size_t row);

/// A bone at one time; its rate and acceleration are in its own space.
struct BoneReading {
  Quat rotation = Quat::Identity();                       // of the bone, in the take's space
  Vec3 rate = Vec3::Zero(), acceleration = Vec3::Zero();  // rad/s; m/s2 with gravity
};

/// Poses around one time, by which derivatives are taken.
struct TimedPose {
  double seconds = 0.0;
  GlobalPose pose;
};

/// Least squares over the poses: parabolas through rotations and places, in the time of the pose
/// that is the `middle` one. At least three poses.
BoneReading bone_reading(std::span<const TimedPose* const> poses, std::size_t middle,
                         const WornOn& bone);

class NodeCompare {
 public:
  NodeCompare(const ImuGroup& group, const Skeleton& skeleton, double rate_hz);

  /// Each row of the take, in order; `keep`: the page keeps it.
  void add(double seconds, const ClipRows& clip, const ImuRows& nodes, std::size_t row, bool keep);
  /// One of each node. `kept_step_s`: between rows that are kept.
  std::vector<NodeFigures> finish(double kept_step_s);

 private:
  /// A row that waits for those behind it, by which derivatives are taken.
  struct Waiting {
    TimedPose pose;
    bool keep = false, known = false;  // known: the mocap's row is valid
    std::vector<NodeReading> nodes;    // of a kept row
  };
  struct Kept {
    std::vector<NodeReading> nodes;  // [S]
    std::vector<BoneReading> bones;  // [candidates_]; empty: not known
  };
  void settle_next();
  double alike(std::size_t node, std::size_t candidate) const;
  std::size_t candidate_of(std::size_t node) const;
  std::string more_like(std::size_t node) const;
  /// A node, and the bone that it is compared with.
  struct Pair {
    std::size_t node = 0, candidate = 0;
  };
  static bool is_known(const Kept& row, const Pair& pair) {
    return !row.bones.empty() && row.nodes[pair.node].valid;
  }
  void compare_rate(const Pair& pair, double kept_step_s, NodeFigures& out) const;
  void compare_acceleration(const Pair& pair, NodeFigures& out) const;
  void compare_orientation(const Pair& pair, NodeFigures& out) const;
  NodeFigures compare(std::size_t node, double kept_step_s) const;

  ImuGroup group_;
  Skeleton skeleton_;
  std::size_t half_window_;                   // rows on each side of one that is differentiated
  double longest_step_s_;                     // between rows of a window: longer ones are gaps
  std::vector<std::optional<WornOn>> named_;  // [S]
  std::vector<WornOn> candidates_;            // the named ones, or one for each joint behind them
  std::deque<Waiting> waiting_;
  std::size_t next_ = 0;  // of waiting_, to be settled
  std::vector<Kept> kept_;
};

}  // namespace kinalign
