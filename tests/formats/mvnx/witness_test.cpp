// SPDX-License-Identifier: Apache-2.0
// One motion that MVN exported twice: the MVNX holds global positions, the BVH angles and bones.
// Each is checked by the other.
#include "tests/formats/reading.h"
#include "tests/shared_data.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/formats/mvnx/mvnx.h"
#include "kinalign/motion/kinematics.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>

using namespace kinalign;

namespace {

/// MVN's segment for each joint of its BVH.
const std::map<std::string, std::string> segment_of{{"Hips", "Pelvis"},
                                                    {"Chest", "L5"},
                                                    {"Chest2", "L3"},
                                                    {"Chest3", "T12"},
                                                    {"Chest4", "T8"},
                                                    {"Neck", "Neck"},
                                                    {"Head", "Head"},
                                                    {"RightCollar", "RightShoulder"},
                                                    {"RightShoulder", "RightUpperArm"},
                                                    {"RightElbow", "RightForeArm"},
                                                    {"RightWrist", "RightHand"},
                                                    {"LeftCollar", "LeftShoulder"},
                                                    {"LeftShoulder", "LeftUpperArm"},
                                                    {"LeftElbow", "LeftForeArm"},
                                                    {"LeftWrist", "LeftHand"},
                                                    {"RightHip", "RightUpperLeg"},
                                                    {"RightKnee", "RightLowerLeg"},
                                                    {"RightAnkle", "RightFoot"},
                                                    {"RightToe", "RightToe"},
                                                    {"LeftHip", "LeftUpperLeg"},
                                                    {"LeftKnee", "LeftLowerLeg"},
                                                    {"LeftAnkle", "LeftFoot"},
                                                    {"LeftToe", "LeftToe"}};

bool is_arm(const std::string& segment) {
  return segment.find("Shoulder") != std::string::npos ||
         segment.find("Arm") != std::string::npos || segment.find("Hand") != std::string::npos;
}

Read<ClipReader> real_mvnx() {
  return read_in_pieces(make_mvnx_reader({}, "real.mvnx.gz"),
                        shared_text("bvh/xsens_mvn_test_mocap.mvnx.gz"), 4096);
}

}  // namespace

TEST_CASE("MVNX and BVH of one motion agree: trunk, head and legs to 0.1 mm, arms to 1.9 mm" *
          doctest::skip(!shared_data())) {
  const auto mvnx = real_mvnx();
  REQUIRE(mvnx.error == "");
  CHECK(mvnx.findings.empty());
  CHECK(mvnx.rows.size() == 112);
  const auto bvh = read_bvh(shared_text("bvh/xsens_mvn_test_mocap.bvh"), "real.bvh", {});
  REQUIRE(bvh);
  const Skeleton& theirs = bvh->clip.skeleton;
  std::vector<double> global(3 * 23 * 112),
      global_bvh(3 * theirs.joints() * bvh->clip.frames.size());
  forward_kinematics(mvnx.header, mvnx.rows, global);
  forward_kinematics(theirs, bvh->clip.frames, global_bvh);
  double body = 0.0, arms = 0.0;
  for (std::size_t j = 0; j < theirs.joints(); ++j) {
    const std::string& segment = segment_of.at(theirs.joint_names[j]);
    const auto& names = mvnx.header.joint_names;
    const auto k =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), segment) - names.begin());
    REQUIRE(k < 23);
    for (std::size_t t = 1; t < 112; ++t) {  // frame 0 of the BVH is a T-pose
      const Vec3 a = vec3(global, 23 * t + k) - vec3(global, 23 * t);
      const Vec3 b =
          vec3(global_bvh, theirs.joints() * t + j) - vec3(global_bvh, theirs.joints() * t);
      // The BVH faces along z, the MVNX along x.
      const double off = (a - Vec3(b.z(), b.y(), -b.x())).norm();
      (is_arm(segment) ? arms : body) = std::max(is_arm(segment) ? arms : body, off);
    }
  }
  CHECK(body < 0.1e-3);
  CHECK(body > 0.0);
  CHECK(arms < 1.95e-3);
  CHECK(arms > 1.0e-3);
}

TEST_CASE("the rest pose of a real MVNX is its identity pose, and the person stands in it" *
          doctest::skip(!shared_data())) {
  const auto mvnx = real_mvnx();
  const Skeleton& s = mvnx.header;
  std::vector<Vec3> places(s.joints());
  for (std::size_t k = 0; k < s.joints(); ++k) {
    places[k] = s.rest_offsets[k];
    if (s.parents[k] >= 0) places[k] += places[static_cast<std::size_t>(s.parents[k])];
  }
  const auto at = [&](const char* name) {
    return places[static_cast<std::size_t>(
        std::find(s.joint_names.begin(), s.joint_names.end(), name) - s.joint_names.begin())];
  };
  // The file's frame of type identity: x, y, z become x, z, -y.
  CHECK((at("Pelvis") - Vec3(0, 0.865664, 0)).norm() < 2e-6);
  CHECK((at("L5") - Vec3(-0.000220, 0.980624, 0)).norm() < 2e-6);
  CHECK((at("Head") - Vec3(0.000488, 1.449109, 0)).norm() < 2e-6);
  CHECK((at("RightUpperArm") - Vec3(0.000180, 1.309677, 0.166456)).norm() < 2e-6);
  CHECK(s.end_sites.size() == 5);
  CHECK(mvnx.rows.stamps.front() == utc_time(1'542'082'631'842'000'000));
  CHECK(mvnx.rows.stamps[60] - mvnx.rows.stamps[0] == Duration{1'000'000'000});
}

TEST_CASE("the sensors of a real MVNX are eleven nodes with orientation and free acceleration" *
          doctest::skip(!shared_data())) {
  const auto read = read_in_pieces(make_mvnx_sensor_reader({}, "real.mvnx.gz"),
                                   shared_text("bvh/xsens_mvn_test_mocap.mvnx.gz"), 65'536);
  CHECK(read.error == "");
  CHECK(read.findings.empty());
  CHECK(read.header.node_names.size() == 11);
  CHECK(read.header.node_names[2] == "Head");
  CHECK(read.header.content == ImuContent{true, true, false, false});
  CHECK(read.rows.size() == 112);
}
