// SPDX-License-Identifier: Apache-2.0
// Channels that a network sees of inertial nodes, the same in training and at use. All channels are
// in the space of the root's node, so the direction in which a person looks does not matter.
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

/// T frames of N calibrated nodes on an even grid. A sample that is not valid may hold any number.
struct NodeFrames {
  std::size_t nodes = 0;
  std::vector<float> orientation;       // [T,N,4] w,x,y,z: the node's bone in the world, y up
  std::vector<float> acceleration;      // [T,N,3] m/s2, in the world, without gravity
  std::vector<float> angular_velocity;  // [T,N,3] rad/s, in the bone's space
  std::vector<std::uint8_t> valid;      // [T,N]

  std::size_t frames() const { return nodes == 0 ? 0 : valid.size() / nodes; }
};

/// The orientation of node `n` in frame `t`; none where the sample is not valid or not finite.
std::optional<Eigen::Quaternionf> orientation_at(const NodeFrames& nodes, std::size_t t,
                                                 std::size_t n);

enum class PoseInputs : std::uint8_t {
  /// Each leaf gives 6 numbers of its rotation against the root and its acceleration minus the
  /// root's. The root gives the vertical and its acceleration. All nodes give their angular
  /// velocity. A flag for each leaf says whether it is valid. Units: 10 m/s2, 3 rad/s.
  ours,
  /// Each leaf gives 9 numbers of its rotation and its acceleration (Huang et al., «Deep inertial
  /// poser», SIGGRAPH Asia 2018).
  dip,
};

struct PoseLayout {
  std::vector<std::string> nodes;  // [N] 3 to 6; the last one is the root's, the others are leaves
  std::vector<std::string> bones;  // [B] whose rotations are answered
  PoseInputs inputs = PoseInputs::ours;
  double rate_hz = 30.0;

  std::size_t leaves() const { return nodes.size() - 1; }
  std::size_t channels() const;
  std::size_t answers() const { return 6 * bones.size(); }

  bool operator==(const PoseLayout&) const = default;
};

inline constexpr std::size_t least_nodes = 3, most_nodes = 6;

/// Fails where the number of nodes is not 3 to 6, a name occurs twice, or the rate is not 0.1 to
/// 10,000 Hz.
Result<void> validate(const PoseLayout& layout);

/// Makes the channels frame after frame. While the root's node is not valid, its last orientation
/// holds; before the first valid one that is the identity. A leaf that is not valid has zeros. A
/// sample with a number that is not finite counts as not valid.
class PoseFeatureMaker {
 public:
  explicit PoseFeatureMaker(const PoseLayout& layout) : layout_(&layout) {}

  /// Fills `out` [channels] from frame `t` of `nodes`, which are the layout's.
  void make(const NodeFrames& nodes, std::size_t t, std::span<float> out);
  /// The same in a space that something else than the root's node gives: `root` in the world.
  void make_in(const Eigen::Quaternionf& root, const NodeFrames& nodes, std::size_t t,
               std::span<float> out);
  /// The root in the world, in the last frame made.
  const Eigen::Quaternionf& root() const { return root_; }

 private:
  const PoseLayout* layout_;
  Eigen::Quaternionf root_ = Eigen::Quaternionf::Identity();
};

struct PoseFeatures {
  std::vector<float> input;              // [T,C]
  std::vector<Eigen::Quaternionf> root;  // [T] the root in the world
};

PoseFeatures pose_features(const PoseLayout& layout, const NodeFrames& nodes);

/// Brings channels [T,C] to mean 0 and deviation 1. `mean`, `scale` [C].
void standardise(std::span<const float> mean, std::span<const float> scale, std::span<float> input);

}  // namespace kinalign
