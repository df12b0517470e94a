// SPDX-License-Identifier: Apache-2.0
// Input channels of a network for inertial nodes, the same in training and in use. All channels are
// in the space of the root's node, so the direction that a person faces does not matter.
#pragma once

#include "kinalign/core/error.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// T frames of N calibrated nodes on an even grid. A sample that is not valid may hold any numbers.
struct NodeFrames {
  std::size_t nodes = 0;
  /// [T,N,4] w,x,y,z: orientation of the node's bone in the world, y up.
  std::vector<float> orientation;
  std::vector<float> acceleration;      // [T,N,3] m/s2, in the world, without gravity
  std::vector<float> angular_velocity;  // [T,N,3] rad/s, in the bone's space
  std::vector<std::uint8_t> valid;      // [T,N] 0: the sample must not be used

  std::size_t frames() const { return nodes == 0 ? 0 : valid.size() / nodes; }
};

/// Appends frames of the same nodes.
void append_frames(NodeFrames& all, const NodeFrames& more);
/// Removes the first `count` frames.
void erase_first_frames(NodeFrames& all, std::size_t count);
/// A copy of frame `t`.
NodeFrames frame_at(const NodeFrames& all, std::size_t t);

/// The orientation of node `n` in frame `t`; empty if the sample is not valid or not finite.
std::optional<Eigen::Quaternionf> orientation_at(const NodeFrames& nodes, std::size_t t,
                                                 std::size_t n);

enum class PoseInputs : std::uint8_t {
  /// Each leaf gives the first two columns (6 numbers) of its rotation relative to the root, and
  /// its acceleration minus the root's. The root gives the vertical and its own acceleration. All
  /// nodes give their angular velocity. One flag per leaf: is it valid? Units: 10 m/s2, 3 rad/s.
  ours,
  /// Each leaf gives its rotation matrix (9 numbers) and its acceleration (Huang et al., «Deep
  /// inertial poser», SIGGRAPH Asia 2018).
  dip,
};

struct PoseLayout {
  /// [N] 3 to 6; the last one is the root's node, the others are leaves.
  std::vector<std::string> nodes;
  std::vector<std::string> bones;  // [B] the bones whose rotations are estimated
  PoseInputs inputs = PoseInputs::ours;
  double rate_hz = 30.0;

  std::size_t leaves() const { return nodes.size() - 1; }
  std::size_t channels() const;
  std::size_t answers() const { return 6 * bones.size(); }

  bool operator==(const PoseLayout&) const = default;
};

inline constexpr std::size_t least_nodes = 3, most_nodes = 6;

/// Fails if the number of nodes is not 3 to 6, a name occurs twice, or the rate is not 0.1 to
/// 10,000 Hz.
Result<void> validate(const PoseLayout& layout);

/// Makes the channels frame after frame. While the root's node is not valid, its last orientation
/// is used, at the start the identity. A leaf that is not valid gives zeros. A sample with a number
/// that is not finite counts as not valid.
class PoseFeatureMaker {
 public:
  explicit PoseFeatureMaker(const PoseLayout& layout) : layout_(&layout) {}

  /// Fills `out` [channels] from frame `t` of `nodes`, which must be the layout's nodes.
  void make(const NodeFrames& nodes, std::size_t t, std::span<float> out);
  /// Fills `out` in the space of `root`, a given rotation in the world, and not of the root's node.
  void make_in(const Eigen::Quaternionf& root, const NodeFrames& nodes, std::size_t t,
               std::span<float> out);
  /// The root's rotation in the world, for the last frame made.
  const Eigen::Quaternionf& root() const { return root_; }

 private:
  const PoseLayout* layout_;
  Eigen::Quaternionf root_ = Eigen::Quaternionf::Identity();
};

struct PoseFeatures {
  std::vector<float> input;              // [T,C] the channels of each frame
  std::vector<Eigen::Quaternionf> root;  // [T] rotation of the root in the world
};

/// The features of all frames.
PoseFeatures pose_features(const PoseLayout& layout, const NodeFrames& nodes);

/// Subtracts `mean` and divides by `scale` [C] in each row of `input` [T,C].
void standardise(std::span<const float> mean, std::span<const float> scale, std::span<float> input);

}  // namespace kinalign
