// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/carried_motion.h"

#include "kinalign/simulate/person/perception_neuron.h"
#include "kinalign/simulate/smooth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace kinalign {

namespace {

/// A joint of the body and its names in three kinds of skeletons. `next`: row of the joint at the
/// end of its bone; -1: the joint gets the recorded rotation instead.
struct CarriedJoint {
  NeuronJoint joint = NeuronJoint::hips;
  std::array<std::string_view, 3> names{};  // Perception Neuron, CMU by cgspeed, CMU's ASF
  int next = -1;
};

constexpr int tip = -2;  // `next` of a foot: its toes, which are not a joint

constexpr std::array<CarriedJoint, 21> carried_joints{
    {{NeuronJoint::hips, {"Hips", "Hips", "root"}},
     {NeuronJoint::right_up_leg, {"RightUpLeg", "RightUpLeg", "rfemur"}, 2},
     {NeuronJoint::right_leg, {"RightLeg", "RightLeg", "rtibia"}, 3},
     {NeuronJoint::right_foot, {"RightFoot", "RightFoot", "rfoot"}, tip},
     {NeuronJoint::left_up_leg, {"LeftUpLeg", "LeftUpLeg", "lfemur"}, 5},
     {NeuronJoint::left_leg, {"LeftLeg", "LeftLeg", "ltibia"}, 6},
     {NeuronJoint::left_foot, {"LeftFoot", "LeftFoot", "lfoot"}, tip},
     {NeuronJoint::spine, {"Spine", "LowerBack", "lowerback"}},
     {NeuronJoint::spine1, {"Spine1", "Spine", "upperback"}},
     {NeuronJoint::spine2, {"Spine2", "Spine", "upperback"}},
     {NeuronJoint::spine3, {"Spine3", "Spine1", "thorax"}},
     {NeuronJoint::neck, {"Neck", "Neck", "lowerneck"}},
     {NeuronJoint::head, {"Head", "Head", "head"}},
     {NeuronJoint::right_shoulder, {"RightShoulder", "RightShoulder", "rclavicle"}, 14},
     {NeuronJoint::right_arm, {"RightArm", "RightArm", "rhumerus"}, 15},
     {NeuronJoint::right_fore_arm, {"RightForeArm", "RightForeArm", "rradius"}, 16},
     {NeuronJoint::right_hand, {"RightHand", "RightHand", "rhand"}},
     {NeuronJoint::left_shoulder, {"LeftShoulder", "LeftShoulder", "lclavicle"}, 18},
     {NeuronJoint::left_arm, {"LeftArm", "LeftArm", "lhumerus"}, 19},
     {NeuronJoint::left_fore_arm, {"LeftForeArm", "LeftForeArm", "lradius"}, 20},
     {NeuronJoint::left_hand, {"LeftHand", "LeftHand", "lhand"}}}};

/// The joint of the source for each row of carried_joints.
using SourceJoints = std::array<std::size_t, carried_joints.size()>;

// Finds the joints by the names of one kind. The result is absent if a name is missing.
std::optional<SourceJoints> joints_of_kind(const Skeleton& skeleton, std::size_t kind) {
  SourceJoints out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& names = skeleton.joint_names;
    const auto found = std::find(names.begin(), names.end(), carried_joints[i].names[kind]);
    if (found == names.end()) return std::nullopt;
    out[i] = static_cast<std::size_t>(found - names.begin());
  }
  return out;
}

// Returns the positions of all joints in the rest pose.
std::vector<Vec3> rest_places(const Skeleton& skeleton) {
  std::vector<Vec3> out;
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    const int parent = skeleton.parents[j];
    const Vec3 from = parent < 0 ? Vec3::Zero() : out[static_cast<std::size_t>(parent)];
    out.push_back(from + skeleton.rest_offsets[j]);
  }
  return out;
}

/// Returns the offset from a joint to its end site or its first child.
Vec3 tip_of(const Skeleton& skeleton, std::size_t joint) {
  for (const EndSite& end : skeleton.end_sites) {
    if (end.parent == static_cast<int>(joint)) return end.offset;
  }
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    if (skeleton.parents[j] == static_cast<int>(joint)) return skeleton.rest_offsets[j];
  }
  return Vec3::Zero();
}

/// Gives a body the poses of the source. Each joint of the body gets a global rotation, so
/// differences between the two hierarchies do not accumulate.
class Carrier {
 public:
  /// Compares the two rest poses once. This gives the rotation that turns each bone of the body
  /// into the direction of the source's bone, and the ratio of the leg lengths.
  Carrier(Motion source, const SourceJoints& joints, Skeleton body)
      : source_(std::move(source)), joints_(joints), body_(std::move(body)) {
    const auto from = rest_places(source_.skeleton), to = rest_places(body_);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const int next = carried_joints[i].next;
      const std::size_t own = index(carried_joints[i].joint);
      row_of_[own] = static_cast<int>(i);
      Vec3 of_body = tip_of(body_, own), of_source = tip_of(source_.skeleton, joints_[i]);
      if (next >= 0) {
        const auto k = static_cast<std::size_t>(next);
        of_body = to[index(carried_joints[k].joint)] - to[own];
        of_source = from[joints_[k]] - from[joints_[i]];
      }
      const bool turns = next != -1 && of_body.norm() > 0.0 && of_source.norm() > 0.0;
      aligned_[i] = turns ? Quat::FromTwoVectors(of_body, of_source) : Quat::Identity();
    }
    scale_ = leg(to, index(NeuronJoint::left_up_leg), index(NeuronJoint::left_foot)) /
             leg(from, joints_[4], joints_[6]);
    origin_ = source_root(0.0);
    origin_.y() = 0.0;
  }

  /// Computes the root's position and all rotations of the body at time t.
  void pose_at(double t, Pose& pose) const {
    Pose local;
    GlobalPose global;
    source_.pose_at(t, local);
    forward_kinematics(source_.skeleton, local, global);
    pose.local_positions = body_.rest_offsets;
    pose.local_positions[0] = scale_ * (global.positions[joints_[0]] - origin_);
    pose.local_rotations.assign(body_.joints(), Quat::Identity());
    std::vector<Quat> turned(body_.joints(), Quat::Identity());
    for (std::size_t j = 0; j < body_.joints(); ++j) {
      const int parent = body_.parents[j];
      const Quat above = parent < 0 ? Quat::Identity() : turned[static_cast<std::size_t>(parent)];
      turned[j] = above;
      if (row_of_[j] < 0) continue;  // fingers stay in their rest pose
      const auto row = static_cast<std::size_t>(row_of_[j]);
      // The global rotation of the source's joint is applied to a bone that has the direction of
      // the source's bone in the rest pose.
      turned[j] = (global.rotations[joints_[row]] * aligned_[row]).normalized();
      pose.local_rotations[j] = above.conjugate() * turned[j];
    }
  }

  const Skeleton& body() const { return body_; }
  bool is_sound() const { return std::isfinite(scale_) && scale_ > 0.0; }

 private:
  static double leg(const std::vector<Vec3>& places, std::size_t hip, std::size_t ankle) {
    return (places[hip] - places[ankle]).norm();
  }
  Vec3 source_root(double t) const {
    Pose local;
    GlobalPose global;
    source_.pose_at(t, local);
    forward_kinematics(source_.skeleton, local, global);
    return global.positions[joints_[0]];
  }
  static std::array<int, neuron_joints> no_rows() {
    std::array<int, neuron_joints> out{};
    out.fill(-1);
    return out;
  }

  Motion source_;
  SourceJoints joints_;
  Skeleton body_;
  std::array<int, neuron_joints> row_of_ = no_rows();  // row in carried_joints; -1: none
  // Rotates the body's bone in the rest pose to the direction of the source's bone.
  std::array<Quat, carried_joints.size()> aligned_{};
  double scale_ = 1.0;
  Vec3 origin_ = Vec3::Zero();
};

/// Returns the time in the motion after `t` seconds of one passage through `length_s` of the
/// motion. The passage accelerates during `ramp_s`, continues at the motion's own speed, and slows
/// down during `ramp_s`. It lasts length_s + ramp_s.
double way(double t, double length_s, double ramp_s) {
  const double all = length_s + ramp_s;
  if (t > 0.5 * all) return length_s - way(all - t, length_s, ramp_s);
  if (t >= ramp_s) return t - 0.5 * ramp_s;
  const double u = std::max(t, 0.0) / ramp_s;  // the integral of rise(), as in glide()
  return ramp_s * u * u * u * u * u * (7.0 + u * (-14.0 + u * (10.0 - 2.5 * u)));
}

}  // namespace

// Each kind of joint names is tried in turn.
Result<Motion> carried_over(Motion source, Skeleton body) {
  for (std::size_t kind = 0; kind < 3; ++kind) {
    const auto joints = joints_of_kind(source.skeleton, kind);
    if (!joints) continue;
    const double length_s = source.length_s;
    const Carrier carrier(std::move(source), *joints, std::move(body));
    if (!carrier.is_sound()) {
      return Failure(Error{"", 0, "a skeleton with legs", "legs of length 0"});
    }
    Skeleton skeleton = carrier.body();
    return Motion{std::move(skeleton), length_s,
                  [carrier](double t, Pose& pose) { carrier.pose_at(t, pose); }};
  }
  return Failure(Error{"", 0, "joint names of Perception Neuron or CMU",
                       std::to_string(source.skeleton.joints()) + " others"});
}

Result<Motion> there_and_back(Motion motion, double begin_s, double end_s, double length_s) {
  constexpr double least_s = 1.0;
  const double own_s = end_s - begin_s, ramp_s = std::min(1.0, 0.5 * own_s);
  if (!(own_s >= least_s && end_s <= motion.length_s)) {
    return Failure(Error{"", 0, "1 s of a motion", fmt::format("{:.2f} s", std::max(own_s, 0.0))});
  }
  Skeleton skeleton = motion.skeleton;
  return Motion{std::move(skeleton), length_s,
                [motion = std::move(motion), begin_s, own_s, ramp_s](double t, Pose& pose) {
                  // One round is a passage forwards and one backwards, both with their slow ends.
                  const double round = 2.0 * (own_s + ramp_s);
                  const double at = t - round * std::floor(t / round);
                  const bool back = at > 0.5 * round;
                  const double on = way(back ? round - at : at, own_s, ramp_s);
                  motion.pose_at(begin_s + on, pose);
                }};
}

}  // namespace kinalign
