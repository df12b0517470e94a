// SPDX-License-Identifier: Apache-2.0
#include "kinalign/simulate/person/perception_neuron.h"

#include "tests/about.h"
#include "tests/seeds.h"

#include "kinalign/motion/kinect_map.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <string_view>

using namespace kinalign;

namespace {

std::vector<Vec3> resting(const Skeleton& skeleton) {
  std::vector<Vec3> at;
  for (std::size_t j = 0; j < skeleton.joints(); ++j) {
    const int parent = skeleton.parents[j];
    at.push_back(skeleton.rest_offsets[j]);
    if (parent >= 0) at.back() += at[static_cast<std::size_t>(parent)];
  }
  return at;
}

double height(const Skeleton& skeleton) {
  const auto at = resting(skeleton);
  return at[index(NeuronJoint::head)].y() + skeleton.end_sites[2].offset.y();
}

}  // namespace

TEST_CASE("names, parents and end sites are those of an Axis Neuron file, in its order") {
  const Skeleton skeleton = perception_neuron(1.75, 0);
  REQUIRE(validate(skeleton));
  REQUIRE(skeleton.joints() == 59);
  // The names in Axis Neuron's BVH files.
  const std::array<std::string_view, 17> begin{
      "Hips",     "RightUpLeg",    "RightLeg", "RightFoot",    "LeftUpLeg", "LeftLeg",
      "LeftFoot", "Spine",         "Spine1",   "Spine2",       "Spine3",    "Neck",
      "Head",     "RightShoulder", "RightArm", "RightForeArm", "RightHand"};
  const std::array<int, 17> parents{-1, 0, 1, 2, 0, 4, 5, 0, 7, 8, 9, 10, 11, 10, 13, 14, 15};
  for (std::size_t j = 0; j < begin.size(); ++j) {
    CHECK(skeleton.joint_names[j] == begin[j]);
    CHECK(skeleton.parents[j] == parents[j]);
  }
  const std::array<std::pair<std::size_t, std::string_view>, 9> later{{{17, "RightHandThumb1"},
                                                                       {20, "RightInHandIndex"},
                                                                       {31, "RightHandRing3"},
                                                                       {35, "RightHandPinky3"},
                                                                       {36, "LeftShoulder"},
                                                                       {39, "LeftHand"},
                                                                       {47, "LeftInHandMiddle"},
                                                                       {51, "LeftInHandRing"},
                                                                       {58, "LeftHandPinky3"}}};
  for (const auto& [j, name] : later) CHECK(skeleton.joint_names[j] == name);
  CHECK(skeleton.parents[36] == 10);
  CHECK(skeleton.parents[51] == 39);
  REQUIRE(skeleton.end_sites.size() == 13);
  const std::array<std::string_view, 13> ends{
      "RightFoot",       "LeftFoot",        "Head",
      "RightHandThumb3", "RightHandIndex3", "RightHandMiddle3",
      "RightHandRing3",  "RightHandPinky3", "LeftHandThumb3",
      "LeftHandIndex3",  "LeftHandMiddle3", "LeftHandRing3",
      "LeftHandPinky3"};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    CHECK(skeleton.joint_names[static_cast<std::size_t>(skeleton.end_sites[i].parent)] == ends[i]);
  }
}

TEST_CASE("a person of 1.75 m has the lengths of the file, in a T-pose that stands on the floor") {
  const Skeleton skeleton = perception_neuron(1.75, 0);
  const auto at = resting(skeleton);
  CHECK(at[0].y() == about(0.9302));
  CHECK(at[index(NeuronJoint::left_leg)].isApprox(Vec3(0.0925, 0.9302 - 0.0159 - 0.4187, 0.0)));
  CHECK(at[index(NeuronJoint::right_hand)].x() == about(-(0.032 + 0.128 + 0.265 + 0.26)));
  CHECK(at[index(NeuronJoint::head)].y() - at[0].y() == about(0.6372));
  CHECK((at[6] + skeleton.end_sites[1].offset).isApprox(Vec3(0.0925, 0.0, 0.175)));
  CHECK(height(skeleton) == about(1.7269));
}

TEST_CASE("people differ in their proportions, not in their height; left and right do not") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    const double size = 1.4 + 0.01 * static_cast<double>(seed % 60);
    const Skeleton person = perception_neuron(size, seed | 1U);
    CHECK(height(person) == about(1.7269 * size / 1.75));
    const Skeleton plain = perception_neuron(size, 0);
    for (std::size_t j = 0; j < 59; ++j) {
      const double ratio = person.rest_offsets[j].norm() / plain.rest_offsets[j].norm();
      CHECK(ratio > 0.9);
      CHECK(ratio < 1.1);
    }
    const auto at = resting(person);
    for (std::size_t j = 0; j < 23; ++j) {
      const Vec3 right = at[13 + j], left = at[36 + j];
      CHECK((left - Vec3(-right.x(), right.y(), right.z())).norm() < 1e-12);
    }
    CHECK(kinect_map(person));
    CHECK(person.rest_offsets == perception_neuron(size, seed | 1U).rest_offsets);
  }
  CHECK(perception_neuron(1.75, 1).rest_offsets != perception_neuron(1.75, 2).rest_offsets);
}
