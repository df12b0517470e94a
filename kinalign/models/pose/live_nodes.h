// SPDX-License-Identifier: Apache-2.0
// Samples of nodes while they come, put onto the even grid of a model of poses: a frame can be made
// as soon as the samples around it are there. The frames are those of even_nodes().
#pragma once

#include "kinalign/models/pose/even_nodes.h"
#include "kinalign/motion/mahony.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// What a node says at one time; absent: not measured.
struct NodeReadings {
  Time stamp{}, arrival{};
  std::optional<Quat> orientation;       // world_from_node, y up; not zero
  std::optional<Vec3> acceleration;      // m/s2
  std::optional<Vec3> angular_velocity;  // rad/s
  bool gravity = true;                   // stands in the acceleration
};

class LiveNodes {
 public:
  /// How long a frame waits for a node that is behind the others. A node's packets have 65 ms of
  /// samples: when one is lost, the next one bridges the gap.
  static constexpr Duration patience = std::chrono::milliseconds(200);
  /// A node that is silent for longer is not waited for.
  static constexpr Duration silence = std::chrono::seconds(1);
  /// A frame needs samples up to so long after it: those that its acceleration is the mean of.
  static constexpr Duration reach{static_cast<std::int64_t>(acceleration_within_s * 1e9)};

  LiveNodes(std::size_t nodes, double rate_hz);

  /// Samples of a node may overtake each other. One of a stamp that is there already, one without
  /// acceleration, with neither orientation nor angular velocity, or without what the node's first
  /// sample had, is left out and counted.
  void add(std::size_t node, const NodeReadings& sample);

  /// Of the root, whose samples begin the grid; absent before the first one.
  const std::optional<Time>& begin() const { return begin_; }
  /// The newest stamp of all nodes; of the root where that is what counts.
  std::optional<Time> newest_of_root() const;
  bool has_samples(std::size_t node) const { return !nodes_[node].track.stamps.empty(); }

  /// Whether the frame at `time` need not wait for further samples. `now`: arrival of the newest
  /// message of any device.
  bool is_ready(Time time, Time now) const;
  /// The frame at `time`. Times rise from call to call: what no later frame needs is forgotten.
  WornFrames frame(Time time);

  std::uint64_t left_out() const { return left_out_; }
  /// Samples that came when a frame which needed them was made already.
  std::uint64_t late() const { return late_; }

 private:
  struct Node {
    NodeTrack track;  // of the last second; its angular velocities may be empty
    bool has_orientation = true, has_angular_velocity = true;
    MahonyFilter filter{};           // where the node sends no orientation
    std::optional<Time> filtered{};  // its newest sample
    Time arrival = Time::min();      // of the newest sample
  };
  static bool fits(const Node& node, const NodeReadings& sample);
  static void insert(Node& node, const NodeReadings& sample);
  static void forget_before(Time time, Node& node);

  double rate_hz_;
  std::vector<Node> nodes_;
  std::optional<Time> begin_, made_;  // made_: the last frame
  std::uint64_t left_out_ = 0, late_ = 0;
};

}  // namespace kinalign
