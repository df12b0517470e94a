// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_skeleton.h"

#include "kinalign/learn/pose/pose_data.h"
#include "kinalign/simulate/person/built_in_motion.h"
#include "kinalign/simulate/person/perception_neuron.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

std::size_t joint(std::string_view name) {
  const auto at = std::find_if(pose_joints.begin(), pose_joints.end(),
                               [&](const PoseJoint& one) { return one.name == name; });
  return static_cast<std::size_t>(at - pose_joints.begin());
}

/// The motion of the built-in person as a file of windows holds it, at 60 Hz.
Windows built_in_windows(double seconds) {
  const auto motion = built_in_motion({.length_s = seconds, .seed = 3});
  REQUIRE(motion);
  const Skeleton& skeleton = motion->skeleton;
  const std::size_t joints = skeleton.joints();
  Windows out;
  out.facts.rate_hz = 60.0;
  out.facts.parts = {"all"};
  out.facts.takes = {{"built-in", "01", "all"}};
  out.facts.streams = {{"mocap", "skeleton", skeleton.joint_names, skeleton.parents}};
  Stretch stretch;
  stretch.rows = static_cast<std::size_t>(60.0 * seconds);
  auto& arrays = stretch.streams["mocap"].arrays;
  Pose pose;
  GlobalPose global;
  for (std::size_t t = 0; t < stretch.rows; ++t) {
    motion->pose_at(static_cast<double>(t) / 60.0, pose);
    forward_kinematics(skeleton, pose, global);
    for (std::size_t j = 0; j < joints; ++j) {
      const Quat& q = pose.local_rotations[j];
      for (const double v : {q.w(), q.x(), q.y(), q.z()})
        arrays["local_rotations"].push_back(static_cast<float>(v));
      for (const double v : global.positions[j])
        arrays["positions"].push_back(static_cast<float>(v));
    }
  }
  out.stretches.push_back(std::move(stretch));
  for (const Vec3& offset : skeleton.rest_offsets) {
    for (const double v : offset) out.rest_offsets["mocap"].push_back(static_cast<float>(v));
  }
  return out;
}

}  // namespace

TEST_CASE("a suit's legs and arms get CMU's zero, and no joint moves") {
  const Skeleton suit = perception_neuron(1.75, 0);
  const auto skeleton = pose_skeleton(suit.joint_names, suit.parents);
  REQUIRE(skeleton);
  const auto offsets = pose_offsets(*skeleton, suit.rest_offsets);
  const auto turns = limb_turns(*skeleton, offsets);
  for (const char* name : {"lfemur", "ltibia", "rfemur", "rtibia", "lhumerus", "rhumerus"}) {
    CAPTURE(name);
    const std::size_t j = joint(name);
    const Vec3 zero = turns[j].transpose() * offsets[j + 1];
    const double expected_x = std::string_view(name).ends_with("humerus") ? 1.0 : 0.342020;
    CHECK(std::abs(zero.normalized().x()) == doctest::Approx(expected_x).epsilon(1e-6));
    CHECK((turns[j] * zero - offsets[j + 1]).norm() < 1e-9);
  }
}

TEST_CASE("the joints of a pose from a suit lie where the suit has them") {
  const Windows windows = built_in_windows(20.0);
  const auto data = pose_data(windows, "mocap", usual_pose_nodes());
  REQUIRE(data);
  REQUIRE(data->learnt.size() == 1);
  const PoseSequence& one = data->learnt[0];
  const auto& names = windows.facts.streams[0].names;
  const auto places = bone_positions(data->body, one.rest_offsets, one.rotations);
  const auto& said = windows.stretches[0].streams.at("mocap").arrays.at("positions");
  const std::array<std::pair<const char*, const char*>, 8> same{{{"lfemur", "LeftUpLeg"},
                                                                 {"ltibia", "LeftLeg"},
                                                                 {"lfoot", "LeftFoot"},
                                                                 {"rfoot", "RightFoot"},
                                                                 {"lhumerus", "LeftArm"},
                                                                 {"lradius", "LeftForeArm"},
                                                                 {"lhand", "LeftHand"},
                                                                 {"head", "Head"}}};
  for (std::size_t t = 0; t < one.frames(); ++t) {
    const float* q = &one.nodes.orientation[4 * (t * 5 + 4)];
    const Eigen::Quaternionf root(q[0], q[1], q[2], q[3]);
    for (const auto& [ours, theirs] : same) {
      const std::size_t j = joint(ours);
      const auto k =
          static_cast<std::size_t>(std::find(names.begin(), names.end(), theirs) - names.begin());
      const Eigen::Vector3f at = root * Eigen::Vector3f(Eigen::Map<const Eigen::Vector3f>(
                                            &places[3 * (t * pose_joints.size() + j)])) +
                                 one.places[t].cast<float>();
      const Eigen::Map<const Eigen::Vector3f> truth(&said[3 * ((4 + 2 * t) * names.size() + k)]);
      CAPTURE(ours);
      REQUIRE((at - truth).norm() < 0.02F);
    }
  }
}

TEST_CASE("a skeleton of neither kind is refused by its first missing joint") {
  CHECK(to_string(pose_skeleton({"a", "b"}, {-1, 0}).error()) ==
        "expected a skeleton with the joints of a suit (LeftUpLeg) or of CMU (lfemur), found no "
        "joint root");
  CHECK(to_string(pose_skeleton({"Hips", "LeftUpLeg"}, {-1, 0}).error()).ends_with("LeftLeg"));
  CHECK(
      to_string(pose_skeleton({"Hips", "LeftUpLeg"}, {1, -1}).error()).ends_with("another order"));
}
