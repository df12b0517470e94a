// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/bone_filter.h"

#include "kinalign/models/body_frame.h"
#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

constexpr float degrees = static_cast<float>(std::numbers::pi / 180.0);

/// A bone, its parent bone ("" is the root), and the node it carries.
struct FilteredBone {
  std::string_view bone, above, node;
};

/// Parents come before their children. The Kinect shows no direction for some bones of the trunk;
/// these keep their rotation relative to their parent.
constexpr std::array<FilteredBone, 15> filtered_bones{{
    {"lowerback", "", ""},
    {"upperback", "lowerback", ""},
    {"thorax", "upperback", ""},
    {"upperneck", "thorax", ""},
    {"head", "upperneck", "head"},
    {"lclavicle", "thorax", ""},
    {"rclavicle", "thorax", ""},
    {"lhumerus", "lclavicle", ""},
    {"lwrist", "lhumerus", "wrist_left"},
    {"rhumerus", "rclavicle", ""},
    {"rwrist", "rhumerus", "wrist_right"},
    {"lfemur", "", ""},
    {"ltibia", "lfemur", "ankle_left"},
    {"rfemur", "", ""},
    {"rtibia", "rfemur", "ankle_right"},
}};

/// A FilteredBone with indices. `above` equal to the number of bones means the root.
struct Part {
  std::size_t bone = 0, above = 0;
  std::optional<SeenBone> seen;
  std::optional<std::size_t> node;
};

/// The filtered bones that the body has. A bone may have a Kinect direction, a node, both or
/// neither.
/// Bones that the body lacks are left out here, so the loop over frames looks nothing up by name.
std::vector<Part> parts_of(const FuseLayout& layout, const PoseBody& body) {
  std::vector<Part> out;
  const auto shown = seen_bones(body, layout.joints);
  for (const FilteredBone& one : filtered_bones) {
    const auto bone = index_of(body.bones, one.bone);
    if (!bone) continue;
    const auto seen = std::find_if(shown.begin(), shown.end(),
                                   [&](const SeenBone& other) { return other.bone == *bone; });
    out.push_back({*bone, index_of(body.bones, one.above).value_or(body.bones.size()),
                   seen == shown.end() ? std::nullopt : std::optional(*seen),
                   index_of(layout.nodes.nodes, one.node)});
  }
  return out;
}

JointFrames smoothed_kinect(const FuseInput& input, const Smoothing& smoothing) {
  JointFrames out = input.kinect;
  fill_missing(out, false);
  smooth(smoothing, 3 * out.joints, out.positions);
  return out;
}

/// Filters one frame after another. A bone that no device measures keeps its last rotation
/// relative to its parent. `world_` has the rotations of the current frame; `held_` has the
/// rotations relative to the parent in the last frame. `layout` and `options` must outlive this
/// object.
class BoneFilter {
 public:
  BoneFilter(const FuseLayout& layout, const PoseBody& body, const BoneFilterOptions& options)
      : layout_(layout),
        options_(options),
        parts_(parts_of(layout, body)),
        hips_(seen_bone(body, layout.joints, "rfemur", "lfemur", "")),
        spine_(seen_bone(body, layout.joints, "root", "upperback", "")),
        held_(body.bones.size(), Turn::Identity()),
        world_(body.bones.size() + 1, Turn::Identity()) {}

  /// Estimates the rotations of root and bones in the world for frame t, and appends the pose. If
  /// the root's node is valid, it is used for the root and not the Kinect.
  void step(const FuseInput& input, const JointFrames& kinect, std::size_t t, FusedPose& out) {
    Turn& root = world_.back();
    if (const auto node = orientation_at(input.nodes, t, layout_.nodes.leaves())) {
      root = node->toRotationMatrix();
    } else {
      turn_root(kinect, t, root);
    }
    for (const Part& part : parts_) turn_part(part, input, kinect, t);
    out.root.emplace_back(root);
    for (std::size_t b = 0; b < held_.size(); ++b) {
      out.rotations.emplace_back(root.transpose() * world_[b]);
    }
  }

 private:
  /// If the root has no valid node, its rotation comes from the Kinect's hips and spine.
  void turn_root(const JointFrames& kinect, std::size_t t, Turn& root) const {
    if (!hips_ || !spine_) return;
    const auto across = direction_at(kinect, t, *hips_), up = direction_at(kinect, t, *spine_);
    if (!across || !up) return;
    const Eigen::Vector3f x = across->direction;
    // The line across the hips is kept as it is. The line of the spine is made perpendicular to it.
    const Eigen::Vector3f y = (up->direction - x.dot(up->direction) * x).normalized();
    root.col(0) = x;
    root.col(1) = y;
    root.col(2) = x.cross(y);
  }

  /// Estimates one bone's rotation in the world. Its parent's rotation of this frame must be known.
  void turn_part(const Part& part, const FuseInput& input, const JointFrames& kinect,
                 std::size_t t) {
    const Turn& above = world_[part.above];
    Turn& own = world_[part.bone];
    std::optional<Eigen::Quaternionf> node;
    if (part.node) node = orientation_at(input.nodes, t, *part.node);
    std::optional<SeenDirection> seen;
    if (part.seen) seen = direction_at(kinect, t, *part.seen);
    if (node) {
      own = node->toRotationMatrix();
    } else {
      // Each frame starts from the rest rotation. Shortest-way rotations added frame after frame
      // would accumulate a twist.
      own = seen ? above : turned_back_to_rotation(above * held_[part.bone]);
    }
    if (seen) turn_along(part.seen->axis, *seen, node.has_value(), own);
    held_[part.bone] = above.transpose() * own;
  }

  /// Turns `own` towards the direction that the Kinect sees, along the shortest way.
  void turn_along(const Eigen::Vector3f& axis, const SeenDirection& seen, bool has_node,
                  Turn& own) const {
    const auto kinect_deg =
        static_cast<float>(seen.tracked ? options_.tracked_deg : options_.inferred_deg);
    const auto node_deg = static_cast<float>(options_.node_deg);
    const Eigen::AngleAxisf way(Eigen::Quaternionf::FromTwoVectors(own * axis, seen.direction));
    float share = 1.0F;
    if (has_node) {
      const float both = node_deg * node_deg + kinect_deg * kinect_deg;
      if (way.angle() > static_cast<float>(options_.gate) * degrees * std::sqrt(both)) return;
      share = node_deg * node_deg / both;
    }
    own = turned_back_to_rotation(Eigen::AngleAxisf(share * way.angle(), way.axis()) * own);
  }

  const FuseLayout& layout_;
  const BoneFilterOptions& options_;
  std::vector<Part> parts_;
  std::optional<SeenBone> hips_, spine_;
  std::vector<Turn> held_;   // rotations relative to the parent bone, in the last frame
  std::vector<Turn> world_;  // rotations in the world; the last element is the root
};

}  // namespace

FusedPose filtered_pose(const FuseLayout& layout, const PoseBody& body, const FuseInput& input,
                        const BoneFilterOptions& options) {
  JointFrames kinect = smoothed_kinect(input, options.smoothing);
  kinect.seen = input.kinect.seen;
  const auto base = index_of(layout.joints, "SpineBase");
  BoneFilter filter(layout, body, options);
  FusedPose out;
  for (std::size_t t = 0; t < input.frames(); ++t) {
    filter.step(input, kinect, t, out);
    out.place.emplace_back(
        Eigen::Map<const Eigen::Vector3f>(&kinect.positions[3 * (t * kinect.joints + *base)]));
  }
  return out;
}

}  // namespace kinalign
