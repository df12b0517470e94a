// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/joint_frames.h"

#include "tests/models/bodies.h"

#include "kinalign/models/joint_names.h"

#include <doctest/doctest.h>

using namespace kinalign;

using Names = std::vector<std::string>;
using Places = std::vector<std::size_t>;

TEST_CASE("mirror: sides are found by the names of every style") {
  CHECK(mirror_partners({"SpineBase", "HipLeft", "HipRight", "Head"}) == Places{0, 2, 1, 3});
  CHECK(mirror_partners({"Hips", "RightUpLeg", "LeftUpLeg", "LeftArm"}) == Places{0, 2, 1, 3});
  CHECK(mirror_partners({"root", "lfemur", "rfemur", "lowerback"}) == Places{0, 2, 1, 3});
  CHECK(mirror_partners({"LWrist", "RWrist", "Root"}) == Places{1, 0, 2});
  CHECK(mirror_partners({"knee_left", "knee_right", ""}) == Places{1, 0, 2});
  CHECK(mirror_partners({}).empty());
}

TEST_CASE("mirror: twice is as before, once exchanges sides and turns x round") {
  const auto partners = mirror_partners(body_joint_names());
  for (std::size_t j = 0; j < partners.size(); ++j) CHECK(partners[partners[j]] == j);
  JointFrames body = moving_body(7, 2);
  for (std::size_t i = 0; i < body.seen.size(); ++i)
    body.seen[i] = static_cast<std::uint8_t>(i % 3);
  const JointFrames before = body;
  mirror(body, partners);
  for (std::size_t t = 0; t < 7; ++t) {
    for (std::size_t j = 0; j < body.joints; ++j) {
      const std::size_t here = t * body.joints + j, there = t * body.joints + partners[j];
      CHECK(body.seen[here] == before.seen[there]);
      CHECK(body.positions[3 * here] == -before.positions[3 * there]);
      CHECK(body.positions[3 * here + 1] == before.positions[3 * there + 1]);
      CHECK(body.positions[3 * here + 2] == before.positions[3 * there + 2]);
    }
  }
  mirror(body, partners);
  CHECK(body.positions == before.positions);
  CHECK(body.seen == before.seen);
}

TEST_CASE("kinect_names: a Kinect's stand, UI-PRMD's and a suit's are translated") {
  const Names kinect{"SpineBase", "Neck", "Tail"};
  CHECK(kinect_names(kinect) == kinect);
  CHECK(kinect_names({"Waist", "Head", "HeadTip", "FootLeft", "ToesLeft"}) ==
        Names{"SpineBase", "Neck", "Head", "AnkleLeft", "FootLeft"});
  CHECK(kinect_names({"Hips", "LeftFoot", "LeftToeBase", "Head", "RightHandThumb1"}) ==
        Names{"SpineBase", "AnkleLeft", "FootLeft", "Head", "RightHandThumb1"});
}

TEST_CASE("kinect_names: a name comes out once") {
  CHECK(kinect_names({"Hips", "HipLeft", "LeftUpLeg"}) ==
        Names{"SpineBase", "HipLeft", "LeftUpLeg"});
}

TEST_CASE("kinect_parents_of: a joint hangs on the nearest one above it that is there") {
  CHECK(kinect_parents_of({"SpineBase", "SpineMid", "SpineShoulder", "Neck", "Head"}) ==
        std::vector<int>{-1, 0, 1, 2, 3});
  CHECK(kinect_parents_of({"Head", "SpineBase", "WristLeft", "Tail"}) ==
        std::vector<int>{1, -1, 1, -1});
  const auto all = kinect_parents_of({kinect_joints.begin(), kinect_joints.end()});
  for (std::size_t j = 0; j < all.size(); ++j) {
    CHECK(all[j] == (j == 0 ? -1 : static_cast<int>(kinect_parents[j])));
  }
}
