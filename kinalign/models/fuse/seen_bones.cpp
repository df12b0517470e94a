// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/seen_bones.h"

#include "kinalign/motion/index_of.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

/// A bone of the body, and the two joints between which a Kinect sees it.
struct SeenWay {
  std::string_view bone, from, to;
};
/// The trunk's lower bone uses the long line from the root to the neck, and its upper bone the line
/// across the shoulders. The Kinect's error for shorter lines is 10 degrees and more.
constexpr std::array<SeenWay, 11> seen_ways{{{"lowerback", "root", "lowerneck"},
                                             {"thorax", "rhumerus", "lhumerus"},
                                             {"upperneck", "lowerneck", "head"},
                                             {"lhumerus", "lhumerus", "lradius"},
                                             {"lwrist", "lradius", "lhand"},
                                             {"rhumerus", "rhumerus", "rradius"},
                                             {"rwrist", "rradius", "rhand"},
                                             {"lfemur", "lfemur", "ltibia"},
                                             {"ltibia", "ltibia", "lfoot"},
                                             {"rfemur", "rfemur", "rtibia"},
                                             {"rtibia", "rtibia", "rfoot"}}};
// A bone is turned by this share of the angle to the seen direction, if the angle is small.
constexpr float seen_share = 0.5F;
// Rad; at this angle the share is halved.
constexpr float far_turn = 0.25F * std::numbers::pi_v<float>;

constexpr float least_length_m = 0.03F;
constexpr float against = -0.5F;  // the cosine of 120 degrees

/// The position of a joint at rest, with all rotations the identity, m; empty if there is no such
/// joint.
std::optional<Vec3> rest_place(const Skeleton& skeleton, std::string_view name) {
  auto at = index_of(skeleton.joint_names, name);
  if (!at) return std::nullopt;
  Vec3 out = Vec3::Zero();
  for (; skeleton.parents[*at] >= 0; at = static_cast<std::size_t>(skeleton.parents[*at])) {
    out += skeleton.rest_offsets[*at];
  }
  return out;
}

}  // namespace

std::optional<std::size_t> kinect_joint_at(const std::vector<std::string>& kinect,
                                           std::string_view body_joint) {
  const auto joint = std::find_if(fuse_joints.begin(), fuse_joints.end(),
                                  [&](const FuseJoint& one) { return one.body == body_joint; });
  return joint == fuse_joints.end() ? std::nullopt : index_of(kinect, joint->kinect);
}

std::optional<SeenBone> seen_bone(const PoseBody& body, const std::vector<std::string>& kinect,
                                  std::string_view from, std::string_view to,
                                  std::string_view bone) {
  const auto begin = kinect_joint_at(kinect, from), end = kinect_joint_at(kinect, to);
  const auto rest_begin = rest_place(body.skeleton, from), rest_end = rest_place(body.skeleton, to);
  if (!begin || !end || !rest_begin || !rest_end) return std::nullopt;
  const Eigen::Vector3f way = (*rest_end - *rest_begin).cast<float>();
  const auto turner = index_of(body.bones, bone);
  if (way.norm() < least_length_m || (!bone.empty() && !turner)) return std::nullopt;
  return SeenBone{*begin, *end, way.normalized(), turner.value_or(body.bones.size())};
}

std::vector<SeenBone> seen_bones(const PoseBody& body, const std::vector<std::string>& kinect) {
  std::vector<SeenBone> out;
  for (const SeenWay& way : seen_ways) {
    if (auto bone = seen_bone(body, kinect, way.from, way.to, way.bone)) out.push_back(*bone);
  }
  return out;
}

std::optional<SeenDirection> direction_at(const JointFrames& kinect, std::size_t t,
                                          const SeenBone& bone) {
  const std::size_t from = t * kinect.joints + bone.from, to = t * kinect.joints + bone.to;
  if (kinect.seen[from] == 0 || kinect.seen[to] == 0) return std::nullopt;
  const Eigen::Vector3f way = Eigen::Map<const Eigen::Vector3f>(&kinect.positions[3 * to]) -
                              Eigen::Map<const Eigen::Vector3f>(&kinect.positions[3 * from]);
  const float length = way.norm();
  if (!std::isfinite(length) || length < least_length_m) return std::nullopt;
  return SeenDirection{way / length, kinect.seen[from] == 2 && kinect.seen[to] == 2};
}

void turn_to_seen(std::span<const SeenBone> bones, const JointFrames& kinect, std::size_t t,
                  const Eigen::Quaternionf& root, std::span<Turn> rotations) {
  for (const SeenBone& bone : bones) {
    const auto seen = direction_at(kinect, t, bone);
    // An inferred joint is the Kinect's own guess, so it does not change the network's rotation.
    if (!seen || !seen->tracked) continue;
    Turn& own = rotations[bone.bone];
    const Eigen::AngleAxisf way(
        Eigen::Quaternionf::FromTwoVectors(own * bone.axis, root.conjugate() * seen->direction));
    const float far = std::pow(way.angle() / far_turn, 4.0F);
    const float angle = seen_share / (1.0F + far) * way.angle();
    own = turned_back_to_rotation(Eigen::AngleAxisf(angle, way.axis()) * own);
  }
}

void unexchange(const FuseLayout& layout, FuseInput& input) {
  const std::vector<std::string>& names = layout.joints;
  JointFrames& kinect = input.kinect;
  // validate() has found both hips.
  const SeenBone hips{*index_of(names, "HipRight"), *index_of(names, "HipLeft"),
                      Eigen::Vector3f::UnitX(), 0};
  const auto partners = mirror_partners(names);
  for (std::size_t t = 0; t < kinect.frames(); ++t) {
    const auto across = direction_at(kinect, t, hips);
    const auto root = orientation_at(input.nodes, t, layout.nodes.leaves());
    if (!across || !root) continue;
    // The root's x axis points to the person's left.
    const Eigen::Vector3f left = *root * hips.axis;
    if (across->direction.dot(left) > against) continue;
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (partners[j] <= j) continue;
      const std::size_t a = t * kinect.joints + j, b = t * kinect.joints + partners[j];
      std::swap_ranges(&kinect.positions[3 * a], &kinect.positions[3 * a] + 3,
                       &kinect.positions[3 * b]);
      std::swap(kinect.seen[a], kinect.seen[b]);
    }
  }
}

}  // namespace kinalign
