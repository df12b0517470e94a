// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_body.h"

#include "kinalign/motion/index_of.h"
#include "kinalign/motion/stamps.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

int place_of(std::span<const std::string> names, std::string_view name) {
  const auto at = index_of(names, name);
  return at ? static_cast<int>(*at) : -1;
}

/// The rotation of joint `j` relative to the root; `frame` [B].
Turn turn_of(const PoseBody& body, std::span<const Turn> frame, std::size_t j) {
  const int bone = body.turned_by[j];
  return bone < 0 ? Turn::Identity() : frame[static_cast<std::size_t>(bone)];
}

/// The height of the root above the lowest joint of a frame, m.
double depth_below_root(std::span<const float> positions, const Turn& root) {
  float lowest = 0.0F;
  for (std::size_t at = 0; at + 3 <= positions.size(); at += 3) {
    const Eigen::Vector3f place(positions[at], positions[at + 1], positions[at + 2]);
    lowest = std::min(lowest, root.row(1).dot(place));
  }
  return -static_cast<double>(lowest);
}

}  // namespace

PoseBody pose_body(std::vector<Vec3> rest_offsets) {
  PoseBody out;
  out.bones.assign(pose_bones.begin(), pose_bones.end());
  Skeleton& skeleton = out.skeleton;
  for (const PoseJoint& joint : pose_joints) {
    skeleton.parents.push_back(place_of(skeleton.joint_names, joint.parent));
    skeleton.joint_names.emplace_back(joint.name);
    out.turned_by.push_back(place_of(out.bones, joint.bone));
  }
  skeleton.rest_offsets = std::move(rest_offsets);
  return out;
}

Result<void> validate(const PoseBody& body) {
  KA_TRY(validate(body.skeleton));
  const std::size_t joints = body.skeleton.joints();
  if (joints == 0 ||
      std::count(body.skeleton.parents.begin(), body.skeleton.parents.end(), -1) != 1) {
    return Failure(Error{"", 0, "a body with one root", "no root, or several"});
  }
  const bool fits = std::all_of(body.turned_by.begin(), body.turned_by.end(), [&](int bone) {
    return bone >= -1 && bone < static_cast<int>(body.bones.size());
  });
  if (body.turned_by.size() != joints || !fits || body.turned_by[0] != -1) {
    return Failure(Error{"", 0, "a bone for each joint below the root", "another list of bones"});
  }
  return {};
}

Turn turn_of_six(const float* six) {
  constexpr float least = 1e-6F;
  Eigen::Vector3f a(six[0], six[1], six[2]), b(six[3], six[4], six[5]);
  // Gram and Schmidt. The small number keeps the answer finite if a network gives zeros.
  a /= a.norm() + least;
  b -= a.dot(b) * a;
  b /= b.norm() + least;
  Turn out;
  out.col(0) = a;
  out.col(1) = b;
  out.col(2) = a.cross(b);
  return out;
}

Turn turn_of_answer(const float* answer) {
  std::array<float, 6> six = six_of_identity;
  for (std::size_t k = 0; k < six.size(); ++k) six[k] += answer[k];
  return turn_of_six(six.data());
}

std::vector<float> bone_positions(const PoseBody& body, std::span<const Vec3> rest_offsets,
                                  std::span<const Turn> rotations) {
  const std::size_t joints = body.skeleton.joints(), bones = body.bones.size();
  const std::size_t frames = rotations.size() / bones;
  std::vector<float> out(frames * joints * 3, 0.0F);
  for (std::size_t t = 0; t < frames; ++t) {
    const std::span<const Turn> frame = rotations.subspan(t * bones, bones);
    for (std::size_t j = 1; j < joints; ++j) {
      const auto parent = static_cast<std::size_t>(body.skeleton.parents[j]);
      Eigen::Map<Eigen::Vector3f> place(&out[(t * joints + j) * 3]);
      place = turn_of(body, frame, parent) * rest_offsets[j].cast<float>();
      place += Eigen::Map<const Eigen::Vector3f>(&out[(t * joints + parent) * 3]);
    }
  }
  return out;
}

ClipFrames clip_frames(const PoseBody& body, std::span<const Turn> rotations,
                       std::span<const Eigen::Quaternionf> root, double rate_hz, Time start) {
  const std::size_t joints = body.skeleton.joints(), bones = body.bones.size();
  const auto positions = bone_positions(body, body.skeleton.rest_offsets, rotations);
  ClipFrames out;
  out.local_positions.resize(root.size() * joints * 3);
  out.local_rotations.resize(root.size() * joints * 4);
  for (std::size_t t = 0; t < root.size(); ++t) {
    out.stamps.push_back(grid_stamp(start, rate_hz, t));
    const std::span<const Turn> frame = rotations.subspan(t * bones, bones);
    const std::span<const float> places(&positions[t * joints * 3], joints * 3);
    const double height = depth_below_root(places, root[t].toRotationMatrix());
    vec3(out.local_positions, t * joints) = Vec3(0.0, height, 0.0);
    put_quat(out.local_rotations, t * joints, root[t].cast<double>().normalized());
    for (std::size_t j = 1; j < joints; ++j) {
      // Networks output rotations relative to the root, so that errors do not add up along a chain.
      // A clip stores them relative to the parent.
      const Turn above = turn_of(body, frame, static_cast<std::size_t>(body.skeleton.parents[j]));
      const Turn local = above.transpose() * turn_of(body, frame, j);
      vec3(out.local_positions, t * joints + j) = body.skeleton.rest_offsets[j];
      put_quat(out.local_rotations, t * joints + j, Quat(local.cast<double>()).normalized());
    }
  }
  return out;
}

}  // namespace kinalign
