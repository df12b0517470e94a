// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/carried_motion.h"

#include "tests/about.h"
#include "tests/motion/rotations.h"

#include "kinalign/motion/rotation.h"
#include "kinalign/simulate/person/built_in_motion.h"
#include "kinalign/simulate/person/perception_neuron.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

Motion walked() {
  auto motion = built_in_motion(
      {.programme = {{Piece::t_pose, 2.0}, {Piece::walk, 12.0}, {Piece::twist, 8.0}}, .seed = 5});
  REQUIRE(motion);
  return *std::move(motion);
}

GlobalPose carried_global(const Motion& motion, double t) {
  Pose pose;
  GlobalPose global;
  motion.pose_at(t, pose);
  forward_kinematics(motion.skeleton, pose, global);
  return global;
}

Vec3 bone(const GlobalPose& pose, NeuronJoint from, NeuronJoint to) {
  return (pose.positions[index(to)] - pose.positions[index(from)]).normalized();
}

/// A skeleton like CMU's in the units of its files: legs apart, other names and lengths.
Motion asf_like(double bend) {
  Skeleton s;
  const auto add = [&](const std::string& name, int parent, const Vec3& offset) {
    s.joint_names.push_back(name);
    s.parents.push_back(parent);
    s.rest_offsets.push_back(offset);
    return static_cast<int>(s.joint_names.size()) - 1;
  };
  const int root = add("root", -1, Vec3(0, 17, 0));
  for (const auto& [side, x] : {std::pair("l", 1.0), std::pair("r", -1.0)}) {
    const std::string n = side;
    const int hip = add(n + "femur", root, Vec3(1.5 * x, -1, 0));
    const int knee = add(n + "tibia", hip, Vec3(2.5 * x, -7, 0));
    const int ankle = add(n + "foot", knee, Vec3(2.5 * x, -7, 0));
    add(n + "toes", ankle, Vec3(0.3 * x, -0.5, 2));
  }
  int up = root;
  for (const char* name : {"lowerback", "upperback", "thorax"}) up = add(name, up, Vec3(0, 2, 0));
  const int neck = add("lowerneck", up, Vec3(0, 2, 0));
  add("head", neck, Vec3(0, 2, 0));
  for (const auto& [side, x] : {std::pair("l", 1.0), std::pair("r", -1.0)}) {
    const std::string n = side;
    const int clavicle = add(n + "clavicle", up, Vec3(0, 1, 0));
    const int shoulder = add(n + "humerus", clavicle, Vec3(3 * x, 1, 0));
    const int elbow = add(n + "radius", shoulder, Vec3(5 * x, 0, 0));
    add(n + "hand", elbow, Vec3(4 * x, 0, 0));
  }
  return {s, 10.0, [s, bend](double t, Pose& pose) {
            pose.local_positions = s.rest_offsets;
            pose.local_positions[0] = Vec3(3.0, 17.0, t);
            pose.local_rotations.assign(s.joints(), Quat::Identity());
            for (std::size_t j = 0; j < s.joints(); ++j) {
              if (s.joint_names[j].ends_with("tibia")) {
                pose.local_rotations[j] = rotation(Vec3(bend, 0, 0));
              }
            }
          }};
}

}  // namespace

TEST_CASE("carried over to the same body, a motion is itself, but for where it begins") {
  const Motion source = walked();
  const auto carried = carried_over(source, source.skeleton);
  REQUIRE(carried);
  const Vec3 begin = carried_global(source, 0.0).positions[0];
  const Vec3 moved(begin.x(), 0.0, begin.z());
  for (double t = 0.0; t < source.length_s; t += 0.37) {
    const GlobalPose one = carried_global(source, t), other = carried_global(*carried, t);
    for (std::size_t j = 0; j < index(NeuronJoint::right_thumb1); ++j) {
      CHECK((one.positions[j] - moved - other.positions[j]).norm() < 1e-9);
    }
  }
}

TEST_CASE(
    "another body's limbs point where the source's point, and its path is as long as its legs") {
  const Motion source = walked();
  const auto carried = carried_over(source, perception_neuron(1.55, 9));
  REQUIRE(carried);
  const auto leg = [](const Skeleton& s) {
    return (s.rest_offsets[index(NeuronJoint::left_leg)] +
            s.rest_offsets[index(NeuronJoint::left_foot)])
        .norm();
  };
  const double scale = leg(carried->skeleton) / leg(source.skeleton);
  CHECK(scale < 0.95);
  for (double t = 0.0; t < source.length_s; t += 0.37) {
    const GlobalPose one = carried_global(source, t), other = carried_global(*carried, t);
    for (const auto& [from, to] :
         {std::pair(NeuronJoint::left_up_leg, NeuronJoint::left_leg),
          std::pair(NeuronJoint::right_leg, NeuronJoint::right_foot),
          std::pair(NeuronJoint::left_arm, NeuronJoint::left_fore_arm),
          std::pair(NeuronJoint::right_fore_arm, NeuronJoint::right_hand)}) {
      CHECK((bone(one, from, to) - bone(other, from, to)).norm() < 1e-9);
    }
    CHECK(other.positions[0].y() == about(scale * one.positions[0].y()));
  }
}

TEST_CASE("CMU's skeleton with its legs apart, in any unit, is carried over by its bones") {
  const Motion source = asf_like(0.8);
  const auto carried = carried_over(source, perception_neuron(1.75, 3));
  REQUIRE(carried);
  const GlobalPose pose = carried_global(*carried, 1.0);
  const Vec3 thigh = Vec3(2.5, -7, 0).normalized();
  CHECK((bone(pose, NeuronJoint::left_up_leg, NeuronJoint::left_leg) - thigh).norm() < 1e-9);
  const Vec3 shank = rotation(Vec3(0.8, 0, 0)) * thigh;
  CHECK((bone(pose, NeuronJoint::left_leg, NeuronJoint::left_foot) - shank).norm() < 1e-9);
  CHECK((bone(pose, NeuronJoint::left_arm, NeuronJoint::left_fore_arm) - Vec3::UnitX()).norm() <
        1e-9);
  const GlobalPose begin = carried_global(*carried, 0.0);
  CHECK(begin.positions[0].x() == about(0.0));
  CHECK(begin.positions[0].z() == about(0.0));
  CHECK(begin.positions[0].y() > 0.6);  // m
  CHECK(begin.positions[0].y() < 1.2);
}

TEST_CASE("a skeleton of other names is refused") {
  Motion source = asf_like(0.0);
  source.skeleton.joint_names[1] = "thigh";
  const auto carried = carried_over(source, perception_neuron(1.75, 3));
  REQUIRE_FALSE(carried);
  CHECK(to_string(carried.error()) ==
        "expected joint names of Perception Neuron or CMU, found 22 others");
}

TEST_CASE("there and back stays within the motion, never faster than it, without a jump") {
  // The joint's position shows the moment of the motion.
  const Motion ticking{{{"root"}, {-1}, {Vec3::Zero()}, {}}, 20.0, [](double t, Pose& pose) {
                         pose.local_positions = {Vec3(t, 0, 0)};
                         pose.local_rotations = {Quat::Identity()};
                       }};
  const auto motion = there_and_back(ticking, 3.0, 9.0, 60.0);
  REQUIRE(motion);
  CHECK(motion->length_s == 60.0);
  const auto at = [&](double t) {
    Pose pose;
    motion->pose_at(t, pose);
    return pose.local_positions[0].x();
  };
  CHECK(at(0.0) == 3.0);
  CHECK(at(3.5) == about(6.0));
  CHECK(at(7.0) == about(9.0));
  CHECK(at(14.0) == about(3.0));
  constexpr double h = 0.01;
  for (double t = h; t < 60.0; t += h) {
    CHECK(at(t) >= 3.0);
    CHECK(at(t) <= 9.0);
    CHECK(std::abs(at(t) - at(t - h)) <= h + 1e-12);
    // The speed grows from rest to the motion's own by at most 35/16 a second.
    CHECK(std::abs(at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h) < 2.2);
  }
  CHECK(there_and_back(ticking, 3.0, 4.0, 60.0));
  CHECK_FALSE(there_and_back(ticking, 3.0, 3.9, 60.0));
  CHECK_FALSE(there_and_back(ticking, 3.0, 21.0, 60.0));
}
