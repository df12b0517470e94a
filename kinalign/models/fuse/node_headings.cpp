// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/node_headings.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/motion/mahony.h"
#include "kinalign/motion/median.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace kinalign {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
// A forearm or shank turns this share of the way to its node (docs/fuse.md, step 6).
constexpr float node_share = 0.75F;

/// The bone that carries a node; "" is the root.
struct CarriedNode {
  std::string_view node, bone;
};
constexpr std::array<CarriedNode, 5> carried_nodes{{{"wrist_left", "lwrist"},
                                                    {"wrist_right", "rwrist"},
                                                    {"ankle_left", "ltibia"},
                                                    {"ankle_right", "rtibia"},
                                                    {"waist", ""}}};

/// The bone that a Kinect sees; for the root the line across the hips.
std::optional<SeenBone> seen_way(const FuseLayout& layout, const PoseBody& body,
                                 std::string_view bone) {
  if (bone.empty()) return seen_bone(body, layout.joints, "rfemur", "lfemur", "");
  for (const SeenBone& seen : seen_bones(body, layout.joints)) {
    if (body.bones[seen.bone] == bone) return seen;
  }
  return std::nullopt;
}

/// The matrix C with C w = v x w.
Eigen::Matrix3d crossing(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

Eigen::Quaternionf turn_by(const Eigen::Vector3f& vector) {
  const float angle = vector.norm();
  if (angle < 1e-9F) return Eigen::Quaternionf::Identity();
  return Eigen::Quaternionf(Eigen::AngleAxisf(angle, vector / angle));
}

Eigen::Quaternionf yaw_turn(float yaw) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(yaw, Eigen::Vector3f::UnitY()));
}

// The filter works in double; the states of all frames are kept in float.
HeadingState state_of(const Eigen::Matrix<double, 4, 1>& mean,
                      const Eigen::Matrix<double, 4, 4>& spread) {
  return {.yaw = static_cast<float>(mean(0)),
          .spread = static_cast<float>(std::sqrt(std::max(spread(0, 0), 0.0))),
          .mount = mean.tail<3>().cast<float>()};
}

}  // namespace

std::vector<CarriedBone> carried_bones(const FuseLayout& layout, const PoseBody& body) {
  std::vector<CarriedBone> out;
  for (const CarriedNode& carried : carried_nodes) {
    const auto node = index_of(layout.nodes.nodes, carried.node);
    const auto bone = index_of(body.bones, carried.bone);
    if (node && bone) out.push_back({*node, *bone});
  }
  return out;
}

void turn_to_nodes(std::span<const CarriedBone> carried, const NodeFrames& nodes, std::size_t t,
                   const Eigen::Quaternionf& root, std::span<Turn> rotations) {
  for (const CarriedBone& one : carried) {
    const auto orientation = orientation_at(nodes, t, one.node);
    if (!orientation) continue;
    Turn& turn = rotations[one.bone];
    turn = Eigen::Quaternionf(turn)
               .slerp(node_share, root.conjugate() * *orientation)
               .toRotationMatrix();
  }
}

Eigen::Quaternionf corrected(const HeadingState& state, const Eigen::Quaternionf& orientation) {
  return yaw_turn(state.yaw) * orientation * turn_by(state.mount);
}

HeadingFilter::HeadingFilter(const FuseLayout& layout, const PoseBody& body, HeadingOptions options)
    : layout_(&layout), options_(options), filters_(layout.nodes.nodes.size()) {
  for (std::size_t n = 0; n < filters_.size(); ++n) {
    const auto carried =
        std::find_if(carried_nodes.begin(), carried_nodes.end(),
                     [&](const CarriedNode& one) { return one.node == layout.nodes.nodes[n]; });
    if (carried == carried_nodes.end()) continue;
    filters_[n].bone = seen_way(layout, body, carried->bone);
  }
  reset();
}

void HeadingFilter::reset() {
  const double heading = options_.heading_deg * degree, mount = options_.mount_deg * degree;
  for (Filter& filter : filters_) {
    filter.mean.setZero();
    filter.spread.setZero();
    filter.spread.diagonal() << heading * heading, mount * mount, mount * mount, mount * mount;
  }
}

// Only the heading drifts. A node does not move on its bone, so the mounting has no noise.
void HeadingFilter::predict(Filter& filter) const {
  const double walk = options_.walk_deg_per_minute * degree;
  filter.spread(0, 0) += walk * walk / (60.0 * layout_->nodes.rate_hz);
}

/// One update of the extended Kalman filter. The gate tests a single measurement's spread. The
/// update uses a larger spread, because errors of successive Kinect frames are correlated.
void HeadingFilter::measure(Filter& filter, const Eigen::Quaternionf& orientation,
                            const SeenDirection& seen) const {
  const HeadingState now = state_of(filter.mean, filter.spread);
  const Eigen::Quaternionf turn = corrected(now, orientation);
  const Eigen::Vector3d axis = filter.bone->axis.cast<double>();
  const Eigen::Vector3d expected = (turn * filter.bone->axis).cast<double>();
  const Eigen::Vector3d miss = seen.direction.cast<double>() - expected;
  // The Jacobian of the expected direction: a small turn about the vertical, then small turns of
  // the node on its bone.
  Eigen::Matrix<double, 3, 4> slope;
  slope.col(0) = Eigen::Vector3d::UnitY().cross(expected);
  slope.rightCols<3>() = -turn.cast<double>().toRotationMatrix() * crossing(axis);
  const double sigma = (seen.tracked ? options_.tracked_deg : options_.inferred_deg) * degree;
  const Eigen::Matrix3d known = slope * filter.spread * slope.transpose();
  const Eigen::Matrix3d one = known + sigma * sigma * Eigen::Matrix3d::Identity();
  if (miss.dot(one.ldlt().solve(miss)) > options_.gate * options_.gate) return;
  const Eigen::Matrix3d all =
      known + options_.frames_as_one * sigma * sigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 4, 3> gain = all.ldlt().solve(slope * filter.spread).transpose();
  filter.mean += gain * miss;
  filter.spread = ((Spread::Identity() - gain * slope) * filter.spread).eval();
  filter.spread = (0.5 * (filter.spread + filter.spread.transpose())).eval();
}

void HeadingFilter::step(const NodeFrames& nodes, std::size_t t,
                         std::span<const std::optional<SeenDirection>> directions) {
  for (std::size_t n = 0; n < filters_.size(); ++n) {
    predict(filters_[n]);
    if (!filters_[n].bone || !directions[n]) continue;
    const auto orientation = orientation_at(nodes, t, n);
    if (orientation) measure(filters_[n], *orientation, *directions[n]);
  }
}

std::vector<std::optional<SeenBone>> HeadingFilter::bones() const {
  std::vector<std::optional<SeenBone>> out;
  for (const Filter& filter : filters_) out.push_back(filter.bone);
  return out;
}

HeadingState HeadingFilter::state(std::size_t node) const {
  return state_of(filters_[node].mean, filters_[node].spread);
}

/// Runs the filter forward, keeps its state in each frame, and smooths backwards.
class HeadingSmoother {
 public:
  static std::vector<HeadingState> smoothed(HeadingFilter filter, const NodeFrames& input,
                                            const NodeDirections& directions) {
    const std::size_t frames = input.frames(), nodes = filter.filters_.size();
    std::vector<HeadingFilter::Filter> after;
    after.reserve(frames * nodes);
    for (std::size_t t = 0; t < frames; ++t) {
      filter.step(input, t, std::span(directions).subspan(t * nodes, nodes));
      after.insert(after.end(), filter.filters_.begin(), filter.filters_.end());
    }
    std::vector<HeadingState> out(frames * nodes);
    for (std::size_t n = 0; n < nodes; ++n) {
      // Each node is smoothed alone, because the filters of two nodes do not depend on each other.
      HeadingFilter::Filter later;
      for (std::size_t t = frames; t-- > 0;) {
        HeadingFilter::Filter& now = after[t * nodes + n];
        if (t + 1 < frames) {
          HeadingFilter::Filter expected = now;
          filter.predict(expected);
          const HeadingFilter::Spread gain = expected.spread.ldlt().solve(now.spread).transpose();
          now.mean += gain * (later.mean - expected.mean);
          now.spread += gain * (later.spread - expected.spread) * gain.transpose();
        }
        later = now;
        out[t * nodes + n] = state_of(now.mean, now.spread);
      }
    }
    return out;
  }
};

NodeDirections directions_of_joints(const HeadingFilter& filter, const JointFrames& kinect) {
  const auto bones = filter.bones();
  NodeDirections out;
  for (std::size_t t = 0; t < kinect.frames(); ++t) {
    for (const auto& bone : bones) {
      out.push_back(bone ? direction_at(kinect, t, *bone) : std::nullopt);
    }
  }
  return out;
}

NodeDirections directions_of_pose(const HeadingFilter& filter, const JointFrames& kinect,
                                  std::span<const Turn> rotations,
                                  std::span<const Eigen::Quaternionf> root) {
  NodeDirections out = directions_of_joints(filter, kinect);
  const auto bones = filter.bones();
  const std::size_t count = root.empty() ? 0 : rotations.size() / root.size();
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!out[i]) continue;
    const std::size_t t = i / bones.size();
    const SeenBone& bone = *bones[i % bones.size()];
    const Turn turn = bone.bone < count ? rotations[t * count + bone.bone] : Turn(Turn::Identity());
    out[i]->direction = (out[i]->direction + root[t] * (turn * bone.axis)).normalized();
  }
  return out;
}

std::vector<HeadingState> node_headings(HeadingFilter filter, const NodeFrames& nodes,
                                        const NodeDirections& directions) {
  return HeadingSmoother::smoothed(std::move(filter), nodes, directions);
}

std::optional<double> shared_heading(const FuseLayout& layout, const FuseInput& input) {
  FuseInput kinect = input;
  std::fill(kinect.nodes.valid.begin(), kinect.nodes.valid.end(), std::uint8_t{0});
  const auto seen = fuse_features(layout, kinect);
  const std::size_t base = 4 * layout.joints.size(), channels = layout.channels();
  std::vector<double> yaws;
  for (std::size_t t = 0; t < input.frames(); ++t) {
    const auto root = orientation_at(input.nodes, t, layout.nodes.leaves());
    if (!root || seen.input[t * channels + base] == 0.0F) continue;
    yaws.push_back(heading_of(seen.space[t].turn.cast<double>()) -
                   heading_of(root->cast<double>()));
  }
  if (static_cast<double>(yaws.size()) < layout.nodes.rate_hz) return std::nullopt;
  // Angles are taken relative to their mean, so that the median does not depend on where they wrap.
  double sine = 0.0, cosine = 0.0;
  for (const double yaw : yaws) {
    sine += std::sin(yaw);
    cosine += std::cos(yaw);
  }
  const double mean = std::atan2(sine, cosine);
  for (double& yaw : yaws) yaw = std::remainder(yaw - mean, 2.0 * std::numbers::pi);
  return mean + upper_median(std::move(yaws));
}

namespace {

/// Corrects all nodes of frame `t`; `states` [N].
void correct_frame(NodeFrames& nodes, std::size_t t, std::span<const HeadingState> states) {
  for (std::size_t n = 0; n < nodes.nodes; ++n) {
    const auto orientation = orientation_at(nodes, t, n);
    if (!orientation) continue;
    const std::size_t at = t * nodes.nodes + n;
    const Eigen::Quaternionf turned = corrected(states[n], *orientation);
    const std::array<float, 4> values{turned.w(), turned.x(), turned.y(), turned.z()};
    std::copy(values.begin(), values.end(), &nodes.orientation[4 * at]);
    Eigen::Map<Eigen::Vector3f> acceleration(&nodes.acceleration[3 * at]);
    acceleration = (yaw_turn(states[n].yaw) * Eigen::Vector3f(acceleration)).eval();
    Eigen::Map<Eigen::Vector3f> rate(&nodes.angular_velocity[3 * at]);
    rate = (turn_by(states[n].mount).conjugate() * Eigen::Vector3f(rate)).eval();
  }
}

}  // namespace

void turn_world(NodeFrames& nodes, double yaw) {
  HeadingState state;
  state.yaw = static_cast<float>(yaw);
  const std::vector<HeadingState> states(nodes.nodes, state);
  for (std::size_t t = 0; t < nodes.frames(); ++t) correct_frame(nodes, t, states);
}

NodeFrames with_headings(NodeFrames nodes, const std::vector<HeadingState>& states) {
  for (std::size_t t = 0; t < nodes.frames(); ++t) {
    correct_frame(nodes, t, std::span(states).subspan(t * nodes.nodes, nodes.nodes));
  }
  return nodes;
}

}  // namespace kinalign
