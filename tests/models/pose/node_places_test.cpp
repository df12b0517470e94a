// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/node_places.h"

#include "tests/models/pose/pose_people.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a node's place is known by the words that devices and suits use") {
  for (const char* name : {"ankle_left", "LeftLowerLeg", "LEFT_LOWER_LEG", "l_shank", "Left Shin",
                           "ankle left", "L_LowLeg2", "shankLeft"}) {
    CAPTURE(name);
    CHECK(place_called(name) == "ankle_left");
  }
  for (const char* name : {"RightForeArm", "RIGHT_LOWER_ARM", "wrist right", "r-wrist"}) {
    CAPTURE(name);
    CHECK(place_called(name) == "wrist_right");
  }
  for (const char* name : {"Pelvis", "HIP", "waist", "Hips"}) CHECK(place_called(name) == "waist");
  CHECK(place_called("Head") == "head");
  for (const char* name :
       {"", "wrist", "LeftUpperArm", "left", "waist left", "imu 3", "Schienbein"})
    CHECK(place_called(name).empty());
}

TEST_CASE("a model's own word for a node comes before others") {
  const std::vector<std::string> names{"hip", "LeftForeArm", "waist"};
  CHECK(node_at(names, "waist") == 2);
  CHECK(node_at(names, "wrist_left") == 1);
  CHECK_FALSE(node_at(names, "wrist_right"));
}

TEST_CASE("worn as described, x lies along the bone and z points away from the body") {
  for (const WornPlace& place : worn_places()) {
    CAPTURE(place.name);
    const Quat worn = worn_in_t_pose(place);
    CHECK((worn * Vec3::UnitX() - Vec3(place.along[0], place.along[1], place.along[2])).norm() <
          1e-12);
    CHECK(
        (worn * Vec3::UnitZ() - Vec3(place.outward[0], place.outward[1], place.outward[2])).norm() <
        1e-12);
  }
  CHECK((worn_in_t_pose(*worn_place("waist")) * Vec3::UnitX()).y() == doctest::Approx(1.0));
  CHECK((worn_in_t_pose(*worn_place("wrist_right")) * Vec3::UnitZ()).y() == doctest::Approx(1.0));
}

TEST_CASE("in a T-pose each bone has the direction that its place states") {
  Skeleton body = pose_body(test_offsets()).skeleton;
  body.rest_offsets[3] = Vec3(0.14, -0.4, 0.0);  // the left shank of a body with its legs apart
  const PoseLayout layout = test_layout();
  const auto turns = t_pose_rotations(layout, body);
  REQUIRE(turns);
  CHECK((*turns)[0].angularDistance(Quat::Identity()) < 1e-9);
  CHECK((*turns)[4].angularDistance(Quat::Identity()) < 1e-9);
  const Vec3 shank = ((*turns)[2] * body.rest_offsets[3]).normalized();
  CHECK(shank.x() == doctest::Approx(0.0));
  CHECK(shank.z() / shank.y() == doctest::Approx(0.34 / 0.94));
}

TEST_CASE("a node without a known place, and a body without its bone, are refused") {
  const Skeleton body = pose_body(test_offsets()).skeleton;
  PoseLayout layout = test_layout();
  layout.nodes[0] = "knee";
  CHECK(to_string(t_pose_rotations(layout, body).error()) ==
        "expected a model for nodes on known places of the body, found knee");
  Skeleton other = body;
  other.joint_names[2] = "shin";
  CHECK(to_string(t_pose_rotations(test_layout(), other).error()) ==
        "expected a body with a bone ltibia for ankle_left, found none");
}
