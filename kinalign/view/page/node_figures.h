// SPDX-License-Identifier: Apache-2.0
// Compares nodes with the bones that they are worn on: the angular velocity and acceleration that
// the mocap's poses imply at the bone, and its orientation. Each comparison uses the best constant
// rotation, since the exact mounting of a node is not known.
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

/// The bone of a node: `turns` has its rotation, and the node lies near the joint `place`.
struct WornOn {
  std::size_t turns = 0, place = 0;
};

/// The bone by the usual names of nodes and joints ("wrist_left", "LeftForeArm"); absent for other
/// names.
/// A node need not lie at the joint that turns its bone: a forearm's node lies near the hand.
std::optional<WornOn> worn_on(const std::string& node, const std::vector<std::string>& joints);

/// A node's values as measured, whatever the take's space: the orientation of the sensor in the
/// node's own world, vectors in the sensor's space.
/// Without an orientation in the stream, `orientation` is the identity.
struct NodeReading {
  bool valid = false;
  Quat orientation = Quat::Identity();
  Vec3 rate = Vec3::Zero(), acceleration = Vec3::Zero();
};

/// Row `row` of a group, brought back from the root node's space.
std::vector<NodeReading> node_readings(const ImuGroup& group, const ImuRows& rows, std::size_t row);

/// A bone at one time. Rate and acceleration are in its own space.
/// A node at this bone would measure these values, but for its mounting and its errors.
struct BoneReading {
  Quat rotation = Quat::Identity();                       // the bone's, in the take's space
  Vec3 rate = Vec3::Zero(), acceleration = Vec3::Zero();  // rad/s; m/s2, without gravity
};

/// A pose and its time; derivatives are taken from several of them.
struct TimedPose {
  double seconds = 0.0;
  GlobalPose pose;
};

/// The derivatives by least squares: parabolas through rotations and places, at the time of pose
/// `middle`. Needs at least three poses.
BoneReading bone_reading(std::span<const TimedPose* const> poses, std::size_t middle,
                         const WornOn& bone);

/// Derivatives of a row need rows on both sides, so rows wait in waiting_ until half_window_ more
/// have come. next_ is the row to compute next; rows before it are kept only as far as its window
/// reaches back. Memory therefore grows with the stored rows alone.
class NodeCompare {
 public:
  NodeCompare(const ImuGroup& group, const Skeleton& skeleton, double rate_hz);

  /// Adds each row of the take, in order. `keep`: the page stores the row.
  void add(double seconds, const ClipRows& clip, const ImuRows& nodes, std::size_t row, bool keep);
  /// The figures of each node. `kept_step_s`: the time between stored rows.
  std::vector<NodeFigures> finish(double kept_step_s);

 private:
  /// A row that waits for the rows after it, which its derivatives need.
  struct Waiting {
    TimedPose pose;
    bool keep = false, known = false;  // known: the mocap's row is valid
    std::vector<NodeReading> nodes;    // only if keep
  };
  struct Kept {
    std::vector<NodeReading> nodes;  // [S]
    std::vector<BoneReading> bones;  // [candidates_]; empty: not known
  };
  void settle_next();
  double alike(std::size_t node, std::size_t candidate) const;
  std::size_t candidate_of(std::size_t node) const;
  std::string more_like(std::size_t node) const;
  /// A node, and the candidate that it is compared with.
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
  std::size_t half_window_;                   // rows on each side of the row to be differentiated
  double longest_step_s_;                     // longer steps within a window are gaps
  std::vector<std::optional<WornOn>> named_;  // [S]
  std::vector<WornOn> candidates_;            // the named ones, then possibly one for each joint
  std::deque<Waiting> waiting_;
  std::size_t next_ = 0;  // index in waiting_ of the next row to compute
  std::vector<Kept> kept_;
};

}  // namespace kinalign
