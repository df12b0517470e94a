// SPDX-License-Identifier: Apache-2.0
// The body of an estimated pose: its joints, and for each joint the bone whose rotation turns it. A
// joint carries the name of the bone that begins there. The names are CMU's (ASF/AMC).
#pragma once

#include "kinalign/motion/clip.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A rotation in a network's form. Its memory is column-major, so the six numbers of a network are
/// the first six of nine.
using Turn = Eigen::Matrix3f;

struct PoseJoint {
  std::string_view name, parent;  // the root has no parent
  std::string_view bone;          // the bone whose rotation the joint has; empty: the root
};

/// Joints of the estimated body, parents first. The foot turns with the shank and the hand with the
/// forearm, because no node measures their own motion.
inline constexpr std::array<PoseJoint, 27> pose_joints{{
    {"root", "", ""},
    {"lfemur", "root", "lfemur"},
    {"ltibia", "lfemur", "ltibia"},
    {"lfoot", "ltibia", "ltibia"},
    {"ltoes", "lfoot", "ltibia"},
    {"rfemur", "root", "rfemur"},
    {"rtibia", "rfemur", "rtibia"},
    {"rfoot", "rtibia", "rtibia"},
    {"rtoes", "rfoot", "rtibia"},
    {"lowerback", "root", "lowerback"},
    {"upperback", "lowerback", "upperback"},
    {"thorax", "upperback", "thorax"},
    {"lowerneck", "thorax", "upperneck"},
    {"upperneck", "lowerneck", "upperneck"},
    {"head", "upperneck", "head"},
    {"lclavicle", "thorax", "lclavicle"},
    {"lhumerus", "lclavicle", "lhumerus"},
    {"lradius", "lhumerus", "lwrist"},
    {"lwrist", "lradius", "lwrist"},
    {"lhand", "lwrist", "lwrist"},
    {"lfingers", "lhand", "lwrist"},
    {"rclavicle", "thorax", "rclavicle"},
    {"rhumerus", "rclavicle", "rhumerus"},
    {"rradius", "rhumerus", "rwrist"},
    {"rwrist", "rradius", "rwrist"},
    {"rhand", "rwrist", "rwrist"},
    {"rfingers", "rhand", "rwrist"},
}};

/// The index of the joint with that name in pose_joints; their number if there is none.
constexpr std::size_t pose_joint_at(std::string_view name) {
  std::size_t out = 0;
  while (out < pose_joints.size() && pose_joints[out].name != name) ++out;
  return out;
}

/// The bones whose rotations a network estimates.
inline constexpr std::array<std::string_view, 15> pose_bones{
    "lfemur", "ltibia",    "rfemur",   "rtibia", "lowerback", "upperback", "thorax", "upperneck",
    "head",   "lclavicle", "lhumerus", "lwrist", "rclavicle", "rhumerus",  "rwrist"};

/// Networks estimate one rotation per bone. Several joints may share it, so there are fewer bones
/// [B] than joints [J].
struct PoseBody {
  Skeleton skeleton;               // joint 0 is the only root
  std::vector<std::string> bones;  // [B] names of the bones
  std::vector<int> turned_by;      // [J] index of the bone; -1: the root's rotation
};

/// The body with the joints of pose_joints. `rest_offsets` [J] m.
PoseBody pose_body(std::vector<Vec3> rest_offsets);

/// Fails if the parts do not fit together or joint 0 is not the only root.
Result<void> validate(const PoseBody& body);

/// A rotation from any six numbers: the first column is along a, the second in the plane of a and b
/// (Zhou et al., CVPR 2019). The loss on tensors computes the same (pose_task.cpp).
Turn turn_of_six(const float* six);

/// The identity in six numbers. It is added to the six numbers of each bone in a network's output.
inline constexpr std::array<float, 6> six_of_identity{1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F};

/// The rotation for six numbers of a network's output.
Turn turn_of_answer(const float* answer);

/// Converts a sum of rotations back to a rotation, by turn_of_six().
inline Turn turned_back_to_rotation(const Turn& sum) { return turn_of_six(sum.data()); }

/// Positions [T,J,3] m relative to the root, in the root's space, from the bones' rotations [T,B]
/// relative to the root. `rest_offsets` [J]: of this body or of another person.
std::vector<float> bone_positions(const PoseBody& body, std::span<const Vec3> rest_offsets,
                                  std::span<const Turn> rotations);

/// Frames of body.skeleton with constant bones. `root` [T]: the root's rotation in the world. Nodes
/// do not measure where a person is, so x and z of the root are 0 and the lowest joint of each
/// frame is at y = 0.
ClipFrames clip_frames(const PoseBody& body, std::span<const Turn> rotations,
                       std::span<const Eigen::Quaternionf> root, double rate_hz, Time start);

}  // namespace kinalign
