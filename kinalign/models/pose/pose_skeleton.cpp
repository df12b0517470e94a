// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_skeleton.h"

#include "kinalign/models/joint_names.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>

namespace kinalign {

namespace {

/// Alternative names of a joint in suits' skeletons; the first one that exists is used.
using OtherNames = std::array<std::string_view, 2>;

/// The source of one joint of pose_joints in a suit's skeleton; see JointSource.
struct SuitJoint {
  std::string_view joint;
  OtherNames turner, from;
  OtherNames to = {};
  double share = 0.0;
  std::array<double, 3> along = {};  // m
};

/// CMU's "lwrist" turns the forearm about its own axis, two thirds along it; "lhand" begins at the
/// wrist. Fingers are placed on the line of the forearm, because suits without gloves have none. No
/// suit has toes; they are placed 13 cm in front of the ankle and 6 cm below it. If a skeleton has
/// one neck joint, the upper neck joint is placed halfway to the head.
constexpr std::array<SuitJoint, pose_joints.size()> suit_joints{{
    {"root", {"Hips"}, {"Hips"}},
    {"lfemur", {"LeftUpLeg"}, {"LeftUpLeg"}},
    {"ltibia", {"LeftLeg"}, {"LeftLeg"}},
    {"lfoot", {"LeftLeg"}, {"LeftFoot"}},
    {"ltoes", {"LeftLeg"}, {"LeftFoot"}, {}, 0.0, {0.0, -0.06, 0.13}},
    {"rfemur", {"RightUpLeg"}, {"RightUpLeg"}},
    {"rtibia", {"RightLeg"}, {"RightLeg"}},
    {"rfoot", {"RightLeg"}, {"RightFoot"}},
    {"rtoes", {"RightLeg"}, {"RightFoot"}, {}, 0.0, {0.0, -0.06, 0.13}},
    {"lowerback", {"Spine"}, {"Spine"}},
    {"upperback", {"Spine1"}, {"Spine1"}},
    {"thorax", {"Spine3", "Spine2"}, {"Spine2"}},
    {"lowerneck", {"Neck"}, {"Neck"}},
    {"upperneck", {"Neck1", "Neck"}, {"Neck"}, {"Head"}, 0.5},
    {"head", {"Head"}, {"Head"}},
    {"lclavicle", {"LeftShoulder"}, {"LeftShoulder"}},
    {"lhumerus", {"LeftArm"}, {"LeftArm"}},
    {"lradius", {"LeftForeArm"}, {"LeftForeArm"}},
    {"lwrist", {"LeftForeArm"}, {"LeftForeArm"}, {"LeftHand"}, 0.67},
    {"lhand", {"LeftForeArm"}, {"LeftHand"}},
    {"lfingers", {"LeftForeArm"}, {"LeftForeArm"}, {"LeftHand"}, 1.15},
    {"rclavicle", {"RightShoulder"}, {"RightShoulder"}},
    {"rhumerus", {"RightArm"}, {"RightArm"}},
    {"rradius", {"RightForeArm"}, {"RightForeArm"}},
    {"rwrist", {"RightForeArm"}, {"RightForeArm"}, {"RightHand"}, 0.67},
    {"rhand", {"RightForeArm"}, {"RightHand"}},
    {"rfingers", {"RightForeArm"}, {"RightForeArm"}, {"RightHand"}, 1.15},
}};

/// For each bone of a limb: the joint at which it ends, and its direction in CMU's rest pose.
struct LimbZero {
  std::string_view bone, end;
  std::array<double, 3> direction;
};
constexpr std::array<LimbZero, 8> limb_zeros{{{"lfemur", "ltibia", {0.342020, -0.939693, 0.0}},
                                              {"ltibia", "lfoot", {0.342020, -0.939693, 0.0}},
                                              {"rfemur", "rtibia", {-0.342020, -0.939693, 0.0}},
                                              {"rtibia", "rfoot", {-0.342020, -0.939693, 0.0}},
                                              {"lhumerus", "lradius", {1.0, 0.0, 0.0}},
                                              {"lwrist", "lwrist", {1.0, 0.0, 0.0}},
                                              {"rhumerus", "rradius", {-1.0, 0.0, 0.0}},
                                              {"rwrist", "rwrist", {-1.0, 0.0, 0.0}}}};

/// The index of the first of the `wanted` names that the file has.
Result<std::size_t> any_of_names(const std::vector<std::string>& names, const OtherNames& wanted) {
  for (const std::string_view name : wanted) {
    if (name.empty()) continue;
    if (const auto at = index_of(names, name)) return *at;
  }
  return Failure(Error{"", 0, "a skeleton with the joints of a suit (LeftUpLeg) or of CMU (lfemur)",
                       "no joint " + std::string(wanted[0])});
}

/// Finds, for each joint of the body, the joints of a suit's skeleton from which it is made.
Result<void> add_suit_joints(PoseSkeleton& out) {
  out.is_cmu = false;
  for (const SuitJoint& joint : suit_joints) {
    JointSource source;
    source.turner = KA_TRY(any_of_names(out.file_names, joint.turner));
    source.from = KA_TRY(any_of_names(out.file_names, joint.from));
    source.to = source.from;
    if (!joint.to[0].empty()) source.to = KA_TRY(any_of_names(out.file_names, joint.to));
    source.share = joint.share;
    source.along = Vec3(joint.along[0], joint.along[1], joint.along[2]);
    out.joints.push_back(source);
  }
  return {};
}

Result<void> add_cmu_joints(PoseSkeleton& out) {
  for (const PoseJoint& joint : pose_joints) {
    const std::size_t at = KA_TRY(any_of_names(out.file_names, {joint.name}));
    out.joints.push_back({at, at, at, 0.0, Vec3::Zero()});
  }
  return {};
}

}  // namespace

Result<PoseSkeleton> pose_skeleton(std::vector<std::string> names, std::vector<int> parents) {
  for (std::size_t j = 0; j < parents.size(); ++j) {
    if (parents[j] < (j == 0 ? -1 : 0) || parents[j] >= static_cast<int>(j)) {
      return Failure(Error{"", 0, "one root, and parents before their children", "another order"});
    }
  }
  PoseSkeleton out{std::move(names), std::move(parents), {}, true};
  if (index_of(out.file_names, "Hips")) {
    KA_TRY(add_suit_joints(out));
  } else {
    KA_TRY(add_cmu_joints(out));
  }
  return out;
}

std::vector<Vec3> pose_offsets(const PoseSkeleton& skeleton, std::span<const Vec3> file_offsets) {
  std::vector<Vec3> file_places, places, out;
  for (std::size_t j = 0; j < file_offsets.size(); ++j) {
    const int parent = skeleton.file_parents[j];
    file_places.push_back(
        parent < 0 ? Vec3::Zero()
                   : Vec3(file_places[static_cast<std::size_t>(parent)] + file_offsets[j]));
  }
  for (std::size_t j = 0; j < pose_joints.size(); ++j) {
    const JointSource& one = skeleton.joints[j];
    places.push_back(file_places[one.from] +
                     one.share * (file_places[one.to] - file_places[one.from]) + one.along);
    if (pose_joints[j].parent.empty()) {
      out.push_back(Vec3::Zero());
    } else {
      out.push_back(places[j] - places[pose_joint_at(pose_joints[j].parent)]);
    }
  }
  return out;
}

std::vector<Eigen::Matrix3d> limb_turns(const PoseSkeleton& skeleton,
                                        std::span<const Vec3> offsets) {
  std::vector<Eigen::Matrix3d> out(pose_joints.size(), Eigen::Matrix3d::Identity());
  if (skeleton.is_cmu) return out;
  for (const LimbZero& limb : limb_zeros) {
    const Vec3 zero(limb.direction[0], limb.direction[1], limb.direction[2]);
    const Quat turn = Quat::FromTwoVectors(zero, offsets[pose_joint_at(limb.end)]);
    for (std::size_t j = 0; j < pose_joints.size(); ++j) {
      if (pose_joints[j].bone == limb.bone) out[j] = turn.toRotationMatrix();
    }
  }
  return out;
}

}  // namespace kinalign
