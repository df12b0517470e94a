// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/clip.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

Skeleton arm() {
  Skeleton s;
  s.joint_names = {"Shoulder", "Elbow", "Wrist"};
  s.parents = {-1, 0, 1};
  s.rest_offsets.assign(3, Vec3::Zero());
  return s;
}

std::string refusal(const Skeleton& skeleton) {
  const auto result = validate(skeleton);
  return result ? "" : to_string(result.error());
}

}  // namespace

TEST_CASE("parents before children under names that differ make a skeleton") {
  CHECK(validate(arm()));
  CHECK(validate(Skeleton{}));
}

TEST_CASE("a skeleton's faults are named") {
  Skeleton s = arm();
  s.parents[1] = 2;
  CHECK(refusal(s) == "expected each parent before its children, found joint 'Elbow'");
  s.parents[1] = 1;
  CHECK(refusal(s) == "expected each parent before its children, found joint 'Elbow'");
  s.parents[1] = -2;
  CHECK(refusal(s) == "expected each parent before its children, found joint 'Elbow'");
  s = arm();
  s.joint_names[2] = "Elbow";
  CHECK(refusal(s) == "expected different joint names, found 'Elbow' twice");
  s = arm();
  s.rest_offsets.pop_back();
  CHECK(refusal(s) ==
        "expected a name, a parent and an offset for each joint, found different numbers");
  s = arm();
  s.end_sites.push_back({3, Vec3::Zero()});
  CHECK(refusal(s) == "expected end sites on joints of the skeleton, found an end site on joint 3");
}
