// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_features.h"

#include "kinalign/motion/index_of.h"

#include <cassert>
#include <cmath>

namespace kinalign {

namespace {

constexpr float smoothing_s = 0.15F;    // time constant of the heading that the Kinect sees
constexpr float least_width_m = 0.15F;  // mean width of hips and shoulders in the floor plane

Eigen::Vector3f joint_at(const JointFrames& kinect, std::size_t t, std::size_t j) {
  return Eigen::Map<const Eigen::Vector3f>(&kinect.positions[3 * (t * kinect.joints + j)]);
}

// A joint whose position is not finite counts as not seen: one NaN would spread through the
// network.
bool is_seen(const JointFrames& kinect, std::size_t t, std::size_t j) {
  return kinect.seen[t * kinect.joints + j] != 0 && joint_at(kinect, t, j).allFinite();
}

}  // namespace

std::vector<std::string> fuse_joint_names() {
  std::vector<std::string> out;
  out.reserve(fuse_joints.size());
  for (const FuseJoint& joint : fuse_joints) out.emplace_back(joint.kinect);
  return out;
}

Result<void> validate(const FuseLayout& layout) {
  KA_TRY(validate(layout.nodes));
  for (const char* name : {"SpineBase", "HipLeft", "HipRight", "ShoulderLeft", "ShoulderRight"}) {
    if (!index_of(layout.joints, name)) {
      return Failure(Error{"", 0, std::string("a joint ") + name, "none"});
    }
  }
  if (layout.nodes.inputs != PoseInputs::ours) {
    return Failure(Error{"", 0, "nodes with the channels \"ours\"", "others"});
  }
  return {};
}

FuseFeatureMaker::FuseFeatureMaker(const FuseLayout& layout)
    : layout_(&layout),
      nodes_(layout.nodes),
      base_(*index_of(layout.joints, "SpineBase")),
      pairs_{
          {{*index_of(layout.joints, "HipLeft"), *index_of(layout.joints, "HipRight")},
           {*index_of(layout.joints, "ShoulderLeft"), *index_of(layout.joints, "ShoulderRight")}}} {
}

/// Updates the space from frame `t`. A body seen from the side has no reliable heading, so its left
/// direction is not updated.
void FuseFeatureMaker::find_space(const FuseInput& input, std::size_t t) {
  const JointFrames& kinect = input.kinect;
  Eigen::Vector2f across = Eigen::Vector2f::Zero();
  for (const auto& [left, right] : pairs_) {
    if (!is_seen(kinect, t, left) || !is_seen(kinect, t, right)) continue;
    const Eigen::Vector3f way = joint_at(kinect, t, left) - joint_at(kinect, t, right);
    across += Eigen::Vector2f(way.x(), way.z());
  }
  if (across.norm() >= 2.0F * least_width_m) {
    // A first-order low-pass over `smoothing_s`. It uses earlier frames only, so the channels are
    // the same live and from a file.
    const float keep = std::exp(-1.0F / (smoothing_s * static_cast<float>(layout_->nodes.rate_hz)));
    left_ = left_ ? Eigen::Vector2f(keep * *left_ + (1.0F - keep) * across) : across;
  }
  if (is_seen(kinect, t, base_)) space_.place = joint_at(kinect, t, base_);
  if (const auto root = orientation_at(input.nodes, t, layout_->nodes.leaves())) {
    space_.turn = *root;
  } else if (left_ && left_->norm() > 1e-3F) {
    // The body's x axis points to its left: the turn about y that maps (1, 0, 0) to that direction.
    space_.turn = Eigen::AngleAxisf(std::atan2(-left_->y(), left_->x()), Eigen::Vector3f::UnitY());
  }
}

void FuseFeatureMaker::make(const FuseInput& input, std::size_t t, std::span<float> out) {
  assert(out.size() == layout_->channels() && input.kinect.joints == layout_->joints.size());
  find_space(input, t);
  const JointFrames& kinect = input.kinect;
  const Eigen::Matrix3f from_world = space_.turn.toRotationMatrix().transpose();
  const bool is_there = is_seen(kinect, t, base_);
  std::size_t next = 0;
  for (std::size_t j = 0; j < kinect.joints; ++j) {
    // Without SpineBase the joints have no origin, so all of them count as missing.
    const bool seen = is_there && is_seen(kinect, t, j);
    const Eigen::Vector3f place =
        seen ? Eigen::Vector3f(from_world * (joint_at(kinect, t, j) - space_.place))
             : Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) out[next++] = place(k);
    out[next++] = seen ? 0.5F * static_cast<float>(kinect.seen[t * kinect.joints + j]) : 0.0F;
  }
  out[next++] = is_there ? 1.0F : 0.0F;
  nodes_.make_in(space_.turn, input.nodes, t, out.subspan(next, layout_->nodes.channels()));
  // The last flag says whether the space is the orientation of the root's node.
  out.back() = orientation_at(input.nodes, t, layout_->nodes.leaves()) ? 1.0F : 0.0F;
}

FuseFeatures fuse_features(const FuseLayout& layout, const FuseInput& input) {
  const std::size_t frames = input.frames(), channels = layout.channels();
  FuseFeatures out;
  out.input.resize(frames * channels);
  out.space.reserve(frames);
  FuseFeatureMaker maker(layout);
  for (std::size_t t = 0; t < frames; ++t) {
    maker.make(input, t, std::span(out.input).subspan(t * channels, channels));
    out.space.push_back(maker.space());
  }
  return out;
}

}  // namespace kinalign
