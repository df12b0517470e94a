// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/shared_joints.h"

#include "kinalign/motion/kinect_joints.h"

#include <doctest/doctest.h>

#include <vector>

using namespace kinalign;

TEST_CASE("shared joints are found among the 25 of the Kinect SDK") {
  const std::vector<std::string> names(kinect_joints.begin(), kinect_joints.end());
  const auto places = shared_joints_among(names);
  REQUIRE(places);
  for (std::size_t j = 0; j < shared_joint_count; ++j) {
    CHECK(names[(*places)[j]] == shared_joints[j]);
  }
}

TEST_CASE("UI-PRMD's joint Head is not the head: HeadTip is") {
  std::vector<std::string> names(shared_joints_in_ui_prmd.begin(), shared_joints_in_ui_prmd.end());
  names.insert(names.begin(), "Head");
  const auto places = shared_joints_among(names);
  REQUIRE(places);
  CHECK((*places)[3] == 4);
  CHECK(names[(*places)[17]] == "ToesRight");
}

TEST_CASE("a missing joint is named") {
  const std::vector<std::string> names{"SpineBase", "SpineMid"};
  const auto places = shared_joints_among(names);
  REQUIRE_FALSE(places);
  CHECK(to_string(places.error()) ==
        "expected a joint SpineShoulder among those of a Kinect, found 2 others");
}

TEST_CASE("joints that are missing have no place, the others keep theirs") {
  const std::vector<std::string> names{"Hand", "SpineMid", "SpineBase"};
  const auto places = shared_joints_there(names);
  CHECK(places[0] == 2);
  CHECK(places[1] == 1);
  for (std::size_t j = 2; j < shared_joint_count; ++j) CHECK_FALSE(places[j]);
}
