// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_features.h"

#include "kinalign/motion/frame_arrays.h"

#include <array>
#include <cassert>
#include <cmath>
#include <set>

namespace kinalign {

namespace {

// Units that bring the channels near 1; docs/formats/model.md states them.
constexpr float acceleration_unit = 10.0F, angular_velocity_unit = 3.0F;  // m/s2, rad/s

/// One sample of one node.
struct NodeSample {
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  Eigen::Vector3f acceleration = Eigen::Vector3f::Zero();
  Eigen::Vector3f angular_velocity = Eigen::Vector3f::Zero();
  bool valid = false;
};

/// The sample of node n in frame t; not valid if a number in it can't be used.
NodeSample sample_of(const NodeFrames& nodes, std::size_t t, std::size_t n) {
  const std::size_t at = t * nodes.nodes + n;
  if (nodes.valid[at] == 0) return {};
  const float* q = &nodes.orientation[4 * at];
  NodeSample out{
      .orientation = {q[0], q[1], q[2], q[3]},
      .acceleration = Eigen::Map<const Eigen::Vector3f>(&nodes.acceleration[3 * at]),
      .angular_velocity = Eigen::Map<const Eigen::Vector3f>(&nodes.angular_velocity[3 * at]),
      .valid = true};
  // A quaternion much shorter than 1 is no orientation, for example four zeros.
  const float length = out.orientation.norm();
  if (!std::isfinite(length) || length < 0.5F || !out.acceleration.allFinite() ||
      !out.angular_velocity.allFinite()) {
    return {};
  }
  out.orientation.coeffs() /= length;
  return out;
}

/// Writes channels one after another.
class Channels {
 public:
  explicit Channels(std::span<float> out) : out_(out) {}
  void put(float value) { out_[next_++] = value; }
  void put(const Eigen::Vector3f& vector, float unit) {
    for (int k = 0; k < 3; ++k) put(vector(k) / unit);
  }
  /// The first columns of a rotation, multiplied by `valid` (0 or 1).
  void put_columns(const Eigen::Matrix3f& rotation, int columns, float valid) {
    for (int k = 0; k < 3 * columns; ++k) put(valid * rotation.data()[k]);
  }

 private:
  std::span<float> out_;
  std::size_t next_ = 0;
};

}  // namespace

void append_frames(NodeFrames& all, const NodeFrames& more) {
  all.nodes = more.nodes;
  append_to(all.orientation, more.orientation);
  append_to(all.acceleration, more.acceleration);
  append_to(all.angular_velocity, more.angular_velocity);
  append_to(all.valid, more.valid);
}

void erase_first_frames(NodeFrames& all, std::size_t count) {
  const std::size_t samples = count * all.nodes;
  erase_first(all.orientation, 4 * samples);
  erase_first(all.acceleration, 3 * samples);
  erase_first(all.angular_velocity, 3 * samples);
  erase_first(all.valid, samples);
}

NodeFrames frame_at(const NodeFrames& all, std::size_t t) {
  const std::size_t nodes = all.nodes;
  return {nodes, row_of(all.orientation, t, 4 * nodes), row_of(all.acceleration, t, 3 * nodes),
          row_of(all.angular_velocity, t, 3 * nodes), row_of(all.valid, t, nodes)};
}

std::size_t PoseLayout::channels() const {
  const std::size_t n = nodes.size();
  return inputs == PoseInputs::dip ? 12 * leaves() : 9 * leaves() + 6 + 3 * n + leaves();
}

Result<void> validate(const PoseLayout& layout) {
  const std::size_t n = layout.nodes.size();
  if (n < least_nodes || n > most_nodes) {
    return Failure(Error{"", 0, "3 to 6 nodes", std::to_string(n)});
  }
  const std::set<std::string> names(layout.nodes.begin(), layout.nodes.end());
  if (names.size() != n) return Failure(Error{"", 0, "nodes with different names", "a name twice"});
  if (layout.bones.empty()) return Failure(Error{"", 0, "bones in the answer", "none"});
  if (!(layout.rate_hz >= 0.1 && layout.rate_hz <= 10'000.0)) {
    return Failure(Error{"", 0, "0.1 to 10,000 frames a second", std::to_string(layout.rate_hz)});
  }
  return {};
}

std::optional<Eigen::Quaternionf> orientation_at(const NodeFrames& nodes, std::size_t t,
                                                 std::size_t n) {
  const NodeSample sample = sample_of(nodes, t, n);
  if (!sample.valid) return std::nullopt;
  return sample.orientation;
}

void PoseFeatureMaker::make(const NodeFrames& nodes, std::size_t t, std::span<float> out) {
  make_in(orientation_at(nodes, t, layout_->leaves()).value_or(root_), nodes, t, out);
}

/// The order of the channels is part of the model's format.
void PoseFeatureMaker::make_in(const Eigen::Quaternionf& own_root, const NodeFrames& nodes,
                               std::size_t t, std::span<float> out) {
  assert(nodes.nodes == layout_->nodes.size() && out.size() == layout_->channels());
  const std::size_t leaves = layout_->leaves();
  const bool is_dip = layout_->inputs == PoseInputs::dip;
  const NodeSample root = sample_of(nodes, t, leaves);
  root_ = own_root;
  const Eigen::Matrix3f root_from_world = root_.toRotationMatrix().transpose();
  std::array<NodeSample, most_nodes> all;
  for (std::size_t n = 0; n < leaves; ++n) all[n] = sample_of(nodes, t, n);
  all[leaves] = root;
  const auto valid = [&](std::size_t n) { return all[n].valid ? 1.0F : 0.0F; };
  Channels channels(out);
  for (std::size_t n = 0; n < leaves; ++n) {
    const Eigen::Matrix3f turn = root_from_world * all[n].orientation.toRotationMatrix();
    channels.put_columns(turn, is_dip ? 3 : 2, valid(n));
  }
  for (std::size_t n = 0; n < leaves; ++n) {
    const Eigen::Vector3f against_root = all[n].acceleration - root.acceleration;
    channels.put(valid(n) * (root_from_world * against_root), acceleration_unit);
  }
  if (is_dip) return;
  channels.put(root_from_world.col(1), 1.0F);
  channels.put(root_from_world * root.acceleration, acceleration_unit);
  for (std::size_t n = 0; n <= leaves; ++n) {
    channels.put(all[n].angular_velocity, angular_velocity_unit);
  }
  for (std::size_t n = 0; n < leaves; ++n) channels.put(valid(n));
}

PoseFeatures pose_features(const PoseLayout& layout, const NodeFrames& nodes) {
  const std::size_t frames = nodes.frames(), channels = layout.channels();
  PoseFeatures out;
  out.input.resize(frames * channels);
  out.root.reserve(frames);
  PoseFeatureMaker maker(layout);
  for (std::size_t t = 0; t < frames; ++t) {
    maker.make(nodes, t, std::span(out.input).subspan(t * channels, channels));
    out.root.push_back(maker.root());
  }
  return out;
}

void standardise(std::span<const float> mean, std::span<const float> scale,
                 std::span<float> input) {
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::size_t c = i % mean.size();
    input[i] = (input[i] - mean[c]) / scale[c];
  }
}

}  // namespace kinalign
