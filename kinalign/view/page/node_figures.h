// SPDX-License-Identifier: Apache-2.0
// Compares nodes with the bones on which they are worn. The mocap's poses give the angular
// velocity, acceleration and orientation of each bone. Each comparison uses the constant rotation
// that fits best, since the exact mounting of a node is not known.
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

/// The bone of a node: `turns` is the joint that rotates the bone; the node is near the joint
/// `place`.
struct WornOn {
  std::size_t turns = 0, place = 0;
};

/// Finds the bone by the usual names of nodes and joints ("wrist_left", "LeftForeArm"). Absent for
/// other names. The two joints may differ: the node of a forearm is near the hand.
std::optional<WornOn> worn_on(const std::string& node, const std::vector<std::string>& joints);

/// A node's values as measured, independent of the take's space: the orientation of the sensor in
/// the node's own world, vectors in the sensor's axes. If the stream has no orientation,
/// `orientation` is the identity.
struct NodeReading {
  bool valid = false;
  Quat orientation = Quat::Identity();
  Vec3 rate = Vec3::Zero(), acceleration = Vec3::Zero();
};

/// Returns row `row` of a group, converted back from the root node's space.
std::vector<NodeReading> node_readings(const ImuGroup& group, const ImuRows& rows, std::size_t row);

/// The motion of a bone at one time. Rate and acceleration are in the bone's axes. Without mounting
/// rotation and errors, a node on this bone would measure these values.
struct BoneReading {
  Quat rotation = Quat::Identity();                       // of the bone, in the take's space
  Vec3 rate = Vec3::Zero(), acceleration = Vec3::Zero();  // rad/s; m/s2, without gravity
};

/// A pose and its time. Derivatives are computed from several such poses.
struct TimedPose {
  double seconds = 0.0;
  GlobalPose pose;
};

/// Computes the derivatives by fitting parabolas to rotations and positions, at the time of pose
/// `middle`. Needs at least three poses.
BoneReading bone_reading(std::span<const TimedPose* const> poses, std::size_t middle,
                         const WornOn& bone);

/// The derivatives of a row need rows on both sides. Rows therefore wait in waiting_ until
/// half_window_ more rows have come. next_ is the index of the next row to compute. Older rows are
/// dropped when no window needs them, so memory grows only with the stored rows.
class NodeCompare {
 public:
  NodeCompare(const ImuGroup& group, const Skeleton& skeleton, double rate_hz);

  /// Adds each row of the take in order. `keep`: the page stores the row.
  void add(double seconds, const ClipRows& clip, const ImuRows& nodes, std::size_t row, bool keep);
  /// Returns the figures of each node. `kept_step_s`: time between stored rows, s.
  std::vector<NodeFigures> finish(double kept_step_s);

 private:
  /// A row that waits for later rows, which its derivatives need.
  struct Waiting {
    TimedPose pose;
    bool keep = false, known = false;  // known: the mocap is valid in this row
    std::vector<NodeReading> nodes;    // only if keep is set
  };
  struct Kept {
    std::vector<NodeReading> nodes;  // [S]
    std::vector<BoneReading> bones;  // [candidates_]; empty: unknown
  };
  void settle_next();
  double alike(std::size_t node, std::size_t candidate) const;
  std::size_t candidate_of(std::size_t node) const;
  std::string more_like(std::size_t node) const;
  /// A node, and the bone with which it is compared.
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
  std::size_t half_window_;                   // rows on each side that are used for a derivative
  double longest_step_s_;                     // a longer step within a window is a gap
  std::vector<std::optional<WornOn>> named_;  // [S]
  std::vector<WornOn> candidates_;            // the named bones; then possibly one for each joint
  std::deque<Waiting> waiting_;
  std::size_t next_ = 0;  // index in waiting_ of the next row to compute
  std::vector<Kept> kept_;
};

}  // namespace kinalign
