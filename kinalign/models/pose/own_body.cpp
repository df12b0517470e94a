// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/own_body.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/models/pose/pose_skeleton.h"

#include <utility>

namespace kinalign {

namespace {

constexpr double legs_of_stature = 0.48;
constexpr double least_bone_m = 1e-3;

}  // namespace

double leg_length(const Skeleton& body) {
  // A joint's rest offset is the bone that ends there: the shank ends at the foot's joint.
  double both = 0.0;
  for (const char* joint : {"ltibia", "lfoot", "rtibia", "rfoot"}) {
    if (const auto at = index_of(body.joint_names, joint)) both += body.rest_offsets[*at].norm();
  }
  return 0.5 * both;
}

double stature_of(const Skeleton& body) { return leg_length(body) / legs_of_stature; }

Skeleton scaled(Skeleton body, double factor) {
  for (Vec3& offset : body.rest_offsets) offset *= factor;
  return body;
}

Result<Skeleton> with_lengths_of(Skeleton body, const Skeleton& own) {
  const PoseSkeleton places = KA_TRY(pose_skeleton(own.joint_names, own.parents));
  const auto offsets = pose_offsets(places, own.rest_offsets);
  for (std::size_t j = 0; j < body.joints(); ++j) {
    const std::size_t at = pose_joint_at(body.joint_names[j]);
    const double length = body.rest_offsets[j].norm();
    // A bone without length has no direction that could be made longer.
    if (at == pose_joints.size() || length < least_bone_m) continue;
    body.rest_offsets[j] *= offsets[at].norm() / length;
  }
  return body;
}

}  // namespace kinalign
