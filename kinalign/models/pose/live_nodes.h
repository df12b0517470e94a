// SPDX-License-Identifier: Apache-2.0
// Resamples live samples of nodes to the even grid of a model of poses. A frame can be made as soon
// as the samples around it have arrived. The frames equal those of even_nodes().
#pragma once

#include "kinalign/models/pose/even_nodes.h"
#include "kinalign/motion/mahony.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace kinalign {

/// The measurements of one node at one time. Absent: not measured.
struct NodeReadings {
  Time stamp{}, arrival{};
  std::optional<Quat> orientation;       // world_from_node, y up; not zero
  std::optional<Vec3> acceleration;      // m/s2
  std::optional<Vec3> angular_velocity;  // rad/s
  bool gravity = true;                   // the acceleration contains gravity
};

/// Keeps the samples of the last second of each node, sorted by stamp. add() is called for each
/// sample, frame() for each time of the grid once is_ready().
class LiveNodes {
 public:
  /// The longest time that a frame waits for a node that is late. One packet holds 65 ms of
  /// samples, so after a lost packet the next one bridges the gap.
  static constexpr Duration patience = std::chrono::milliseconds(200);
  /// A node without a sample for longer than this is not waited for.
  static constexpr Duration silence = std::chrono::seconds(1);
  /// A frame needs samples up to this long after it, because its acceleration is their mean.
  static constexpr Duration reach = from_seconds(acceleration_within_s);

  LiveNodes(std::size_t nodes, double rate_hz);

  /// Adds a sample. It is dropped and counted in left_out() in these cases: its stamp is a
  /// duplicate; it has no acceleration; it has neither orientation nor angular velocity with
  /// gravity; it lacks a quantity that the node's first sample had, or differs in gravity; it
  /// arrives out of order and the node sends no orientation; 4096 samples of the node are kept.
  void add(std::size_t node, const NodeReadings& sample);

  /// The stamp of the root's first sample, at which the grid begins; absent before it.
  const std::optional<Time>& begin() const { return begin_; }
  /// The newest stamp of the root's node; absent before its first sample.
  std::optional<Time> newest_of_root() const;
  bool has_samples(std::size_t node) const { return !nodes_[node].track.stamps.empty(); }

  /// True if the frame at `time` need not wait for further samples. `now`: arrival of the newest
  /// message of any device.
  bool is_ready(Time time, Time now) const;
  /// The frame at `time`. Times must rise from call to call, because samples that no later frame
  /// needs are dropped.
  WornFrames frame(Time time);

  /// Number of samples dropped by add().
  std::uint64_t left_out() const { return left_out_; }
  /// Number of samples that arrived after the frame at their stamp, or a later one, was made.
  std::uint64_t late() const { return late_; }

 private:
  struct Node {
    NodeTrack track;  // samples of the last second; angular velocities may be empty
    bool has_orientation = true, has_angular_velocity = true;
    MahonyFilter filter{};           // used if the node sends no orientation
    std::optional<Time> filtered{};  // the newest sample given to `filter`
    Time arrival = Time::min();      // arrival of the newest sample
  };
  static bool fits(const Node& node, const NodeReadings& sample);
  static void insert(Node& node, const NodeReadings& sample);
  static void forget_before(Time time, Node& node);

  double rate_hz_;
  std::vector<Node> nodes_;
  std::optional<Time> begin_, made_;  // begin_: see begin(); made_: time of the last frame made
  std::uint64_t left_out_ = 0, late_ = 0;
};

}  // namespace kinalign
