// SPDX-License-Identifier: Apache-2.0
// Where the joints that a pose is answered on lie in another skeleton: CMU's own, or those of usual
// mocap suits by their names ("LeftUpLeg": Perception Neuron, Axis Studio and others).
#pragma once

#include "kinalign/models/pose/pose_body.h"

#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// A joint of pose_joints. Its place is `from` + `share` (`to` - `from`) + `along`.
struct JointSource {
  std::size_t turner = 0;        // the file's joint whose rotation it has
  std::size_t from = 0, to = 0;  // the file's joints
  double share = 0.0;
  Vec3 along = Vec3::Zero();  // m, in the turner's space
};

struct PoseSkeleton {
  std::vector<std::string> file_names;
  std::vector<int> file_parents;
  std::vector<JointSource> joints;  // [pose_joints]
  bool is_cmu = true;               // limbs have CMU's zero

  std::size_t file_joints() const { return file_names.size(); }
};

/// Fails where there is not one root with parents before their children, or where joints are
/// missing: it names the first.
Result<PoseSkeleton> pose_skeleton(std::vector<std::string> names, std::vector<int> parents);

/// Offsets [pose_joints] m, each from its parent in pose_joints, of a person whose file has these
/// rest offsets.
std::vector<Vec3> pose_offsets(const PoseSkeleton& skeleton, std::span<const Vec3> file_offsets);

/// For each joint of a limb the turn X that brings its rotation G to CMU's zero: G becomes G X. In
/// CMU's rest pose arms lie along x and legs are spread by 20 degrees. The identity for all others,
/// and of CMU's own skeletons.
std::vector<Eigen::Matrix3d> limb_turns(const PoseSkeleton& skeleton,
                                        std::span<const Vec3> offsets);

}  // namespace kinalign
