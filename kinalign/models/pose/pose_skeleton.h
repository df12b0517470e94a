// SPDX-License-Identifier: Apache-2.0
// Finds the joints of pose_joints in another skeleton: CMU's own, or that of a usual mocap suit, by
// its names ("LeftUpLeg": Perception Neuron, Axis Studio and others).
#pragma once

#include "kinalign/models/pose/pose_body.h"

#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The place of one joint of pose_joints: `from` + `share` (`to` - `from`) + `along`.
struct JointSource {
  std::size_t turner = 0;        // index of the file's joint whose rotation it has
  std::size_t from = 0, to = 0;  // indices of the file's joints
  double share = 0.0;            // 0 at `from`, 1 at `to`
  Vec3 along = Vec3::Zero();     // m, in the turner's space
};

struct PoseSkeleton {
  std::vector<std::string> file_names;
  std::vector<int> file_parents;
  std::vector<JointSource> joints;  // one source for each of pose_joints
  bool is_cmu = true;               // the limbs' rotations refer to CMU's rest pose

  std::size_t file_joints() const { return file_names.size(); }
};

/// Fails if there is not exactly one root, if a child comes before its parent, or if joints are
/// missing; the message names the first missing one.
Result<PoseSkeleton> pose_skeleton(std::vector<std::string> names, std::vector<int> parents);

/// Offsets [pose_joints] m, each from its parent in pose_joints, for a person whose file has these
/// rest offsets.
std::vector<Vec3> pose_offsets(const PoseSkeleton& skeleton, std::span<const Vec3> file_offsets);

/// For each joint of a limb the rotation X that changes its rest pose to CMU's: its rotation G
/// becomes G X. In CMU's rest pose arms lie along x and legs are spread by 20 degrees. X is the
/// identity for all other joints and in CMU's own skeletons.
std::vector<Eigen::Matrix3d> limb_turns(const PoseSkeleton& skeleton,
                                        std::span<const Vec3> offsets);

}  // namespace kinalign
