// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/kinect_map.h"

#include "tests/about.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>

using namespace kinalign;

namespace {

struct Given {
  const char* name;
  int parent;
  Vec3 cm;                  // offset
  Vec3 end = Vec3::Zero();  // cm; zero: none
};

Skeleton skeleton_of(std::initializer_list<Given> joints) {
  Skeleton skeleton;
  for (const Given& joint : joints) {
    const int index = static_cast<int>(skeleton.joints());
    skeleton.joint_names.emplace_back(joint.name);
    skeleton.parents.push_back(joint.parent);
    skeleton.rest_offsets.emplace_back(0.01 * joint.cm);
    if (!joint.end.isZero()) skeleton.end_sites.push_back({index, 0.01 * joint.end});
  }
  return skeleton;
}

/// The joints that the map needs, of a person of 1.75 m, as Axis Neuron writes it.
Skeleton legacy() {
  return skeleton_of({{"Hips", -1, {0, 93.02, 0}},
                      {"RightUpLeg", 0, {-9.25, -1.59, 0}},
                      {"RightLeg", 1, {0, -41.87, 0}},
                      {"RightFoot", 2, {0, -41.87, 0}, {0, -7.69, 17.5}},
                      {"LeftUpLeg", 0, {9.25, -1.59, 0}},
                      {"LeftLeg", 4, {0, -41.87, 0}},
                      {"LeftFoot", 5, {0, -41.87, 0}, {0, -7.69, 17.5}},
                      {"Spine", 0, {0, 14.307, 0}},
                      {"Spine1", 7, {0, 9.718, 0}},
                      {"Spine2", 8, {0, 10.12, 0}},
                      {"Spine3", 9, {0, 9.718, 0}},
                      {"Neck", 10, {0, 10.387, 0}},
                      {"Head", 11, {0, 9.47, 0}, {0, 15.95, 0}},
                      {"RightArm", 10, {-16, 6.925, 0}},
                      {"RightForeArm", 13, {-26.5, 0, 0}},
                      {"RightHand", 14, {-26, 0, 0}},
                      {"RightHandThumb2", 15, {-4, 0, 3}},
                      {"RightHandThumb3", 16, {-2, 0, 0}},
                      {"RightInHandMiddle", 15, {-4, 0, 0}},
                      {"RightHandMiddle1", 18, {-5, 0, 0}},
                      {"RightHandMiddle3", 19, {-6, 0, 0}, {-2, 0, 0}},
                      {"LeftArm", 10, {16, 6.925, 0}},
                      {"LeftForeArm", 21, {26.5, 0, 0}},
                      {"LeftHand", 22, {26, 0, 0}},
                      {"LeftHandThumb2", 23, {4, 0, 3}},
                      {"LeftHandThumb3", 24, {2, 0, 0}},
                      {"LeftInHandMiddle", 23, {4, 0, 0}},
                      {"LeftHandMiddle1", 26, {5, 0, 0}},
                      {"LeftHandMiddle3", 27, {6, 0, 0}, {2, 0, 0}}});
}

Pose rest(const Skeleton& skeleton) {
  Pose pose;
  pose.local_positions = skeleton.rest_offsets;
  pose.local_rotations.assign(skeleton.joints(), Quat::Identity());
  return pose;
}

std::vector<double> mapped(const Skeleton& skeleton, const Pose& pose) {
  const auto map = kinect_map(skeleton);
  REQUIRE(map);
  GlobalPose global;
  forward_kinematics(skeleton, pose, global);
  std::vector<double> out(75);
  kinect_positions(*map, global, out);
  return out;
}

Vec3 cm_of(const std::vector<double>& positions, std::string_view joint) {
  const auto found = std::find(kinect_joints.begin(), kinect_joints.end(), joint);
  return 100.0 * vec3(positions, static_cast<std::size_t>(found - kinect_joints.begin()));
}

void rename(Skeleton& skeleton, const char* from, const char* to) {
  *std::find(skeleton.joint_names.begin(), skeleton.joint_names.end(), from) = to;
}

bool near(const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-9; }

}  // namespace

TEST_CASE("a Perception Neuron's joints lie where a Kinect's do by height") {
  const Skeleton skeleton = legacy();
  const auto p = mapped(skeleton, rest(skeleton));
  CHECK(near(cm_of(p, "SpineBase"), {0, 93.02, 0}));
  CHECK(near(cm_of(p, "SpineMid"), {0, 93.02 + 34.145, 0}));
  CHECK(near(cm_of(p, "SpineShoulder"), {0, 93.02 + 54.25, 0}));
  CHECK(near(cm_of(p, "Neck"), {0, 93.02 + 63.72, 0}));
  CHECK(near(cm_of(p, "Head"), {0, 93.02 + 63.72 + 0.87 * 15.95, 0}));
  CHECK(near(cm_of(p, "ShoulderLeft"), {16, 93.02 + 43.863 + 6.925, 0}));
  CHECK(near(cm_of(p, "WristRight"), {-68.5, 93.02 + 43.863 + 6.925, 0}));
  CHECK(near(cm_of(p, "HandLeft"), {68.5 + 4 + 2.5, 93.02 + 50.788, 0}));
  CHECK(near(cm_of(p, "HandTipLeft"), {68.5 + 17, 93.02 + 50.788, 0}));
  CHECK(near(cm_of(p, "ThumbRight"), {-68.5 - 5, 93.02 + 50.788, 3}));
  CHECK(near(cm_of(p, "HipLeft"), {0.7 * 9.25, 93.02 - 1.59, 0}));
  CHECK(near(cm_of(p, "KneeRight"), {-9.25, 93.02 - 1.59 - 41.87, 0}));
  CHECK(near(cm_of(p, "AnkleLeft"), {9.25, 7.69, 0}));
  CHECK(near(cm_of(p, "FootRight"), {-9.25, 7.69 - 0.7 * 7.69, 0.7 * 17.5}));
}

TEST_CASE("end sites turn with their joint") {
  const Skeleton skeleton = legacy();
  Pose pose = rest(skeleton);
  pose.local_rotations[6] = Quat(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));
  const auto p = mapped(skeleton, pose);
  CHECK(near(cm_of(p, "FootLeft"), {9.25 + 0.7 * 17.5, 7.69 - 0.7 * 7.69, 0}));
  CHECK(near(cm_of(p, "AnkleLeft"), {9.25, 7.69, 0}));
}

TEST_CASE("Axis Studio's second neck tells its hierarchy from the older one") {
  Skeleton skeleton = legacy();
  // Heights 7.8, 25.1, 37.4, 55.8, 60.6, 65.3 above the hips, as in Axis Studio.
  rename(skeleton, "Neck", "Neck1");
  rename(skeleton, "Spine3", "Neck");
  const double heights[] = {7.8, 17.3, 12.3, 18.4, 4.8, 4.7};
  for (std::size_t i = 0; i < 6; ++i) skeleton.rest_offsets[7 + i].y() = 0.01 * heights[i];
  const auto p = mapped(skeleton, rest(skeleton));
  CHECK(cm_of(p, "SpineMid").y() - 93.02 == about(32.0, 0.002));
  CHECK(cm_of(p, "SpineShoulder").y() - 93.02 == about(55.8, 0.002));
  CHECK(cm_of(p, "Neck").y() - 93.02 == about(62.95, 0.002));
  CHECK(cm_of(p, "Head").y() - 93.02 == about(78.1, 0.002));
}

TEST_CASE("CMU's joints go by name") {
  Skeleton skeleton = legacy();
  for (const auto& [from, to] : {std::pair{"Spine2", "Spine4"},
                                 {"Spine3", "Neck1"},
                                 {"LeftInHandMiddle", "LeftFingerBase"},
                                 {"LeftHandMiddle3", "LeftHandIndex1"},
                                 {"LeftHandThumb2", "LThumb"},
                                 {"RightInHandMiddle", "RightFingerBase"},
                                 {"RightHandMiddle3", "RightHandIndex1"},
                                 {"RightHandThumb2", "RThumb"},
                                 {"LeftHandThumb3", "LeftToeBase"},
                                 {"RightHandThumb3", "RightToeBase"}}) {
    rename(skeleton, from, to);
  }
  const auto p = mapped(skeleton, rest(skeleton));
  CHECK(near(cm_of(p, "SpineMid"), {0, 93.02 + 14.307, 0}));
  CHECK(near(cm_of(p, "Neck"), {0, 93.02 + 54.25, 0}));
  CHECK(near(cm_of(p, "HandTipRight"), {-68.5 - 17, 93.02 + 50.788, 0}));
}

TEST_CASE("what is missing is named, against the nearest skeleton that we know") {
  Skeleton skeleton = legacy();
  rename(skeleton, "LeftHandThumb2", "Daumen");
  skeleton.end_sites.erase(skeleton.end_sites.begin() + 2);  // the end site of the head
  const auto map = kinect_map(skeleton);
  REQUIRE_FALSE(map);
  CHECK(
      to_string(map.error()) ==
      "expected a skeleton with the joints of Perception Neuron, Axis Studio or CMU, here nearest "
      "to Perception Neuron's, found no joint called an end site of Head, LeftHandThumb2");
  CHECK_FALSE(kinect_map(Skeleton{}));
}
