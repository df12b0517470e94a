// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_model.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string refusal_of(const FuseModel& model) {
  const auto again = read_fuse_model(write_fuse_model(model), "m");
  return again ? "none" : to_string(again.error());
}

}  // namespace

TEST_CASE("a fusing model's file is read as it was written") {
  const FuseModel model = random_fuse_model(1);
  const std::string bytes = write_fuse_model(model);
  const auto again = read_fuse_model(bytes, "m");
  REQUIRE(again);
  CHECK(again->layout == model.layout);
  CHECK(again->tensors == model.tensors);
  CHECK(again->body.skeleton.rest_offsets == model.body.skeleton.rest_offsets);
  CHECK(write_fuse_model(*again) == bytes);
}

TEST_CASE("a fusing model whose parts do not fit is refused") {
  FuseModel other = random_fuse_model(1);
  other.facts.task = "pose";
  CHECK(refusal_of(other) ==
        "m: expected a model for a Kinect and nodes together, found task pose");
  other = random_fuse_model(1);
  std::erase(other.layout.joints, "ShoulderLeft");
  CHECK(refusal_of(other) == "m: expected a joint ShoulderLeft, found none");
  other = random_fuse_model(1);
  other.input_scale[3] = 0.0F;
  CHECK(refusal_of(other) != "none");
  other = random_fuse_model(1);
  other.layout.joints.emplace_back("Tail");
  CHECK(refusal_of(other) != "none");
  other.layout = fuse_test_layout();
  other.layout.joints.pop_back();
  CHECK(to_string(Fuser::make(other).error()).find("channels in") != std::string::npos);
}

TEST_CASE("the fused skeleton has bones of one length, at the Kinect's place") {
  const FusePerson person = fuse_person(30);
  auto fuser = Fuser::make(random_fuse_model(3));
  REQUIRE(fuser);
  const Clip clip = fuser->clip(person.input, Time{});
  const std::size_t joints = clip.skeleton.joints();
  REQUIRE(clip.frames.size() == 30);
  for (std::size_t t = 0; t < 30; ++t) {
    for (std::size_t j = 1; j < joints; ++j) {
      CHECK(Vec3(vec3(clip.frames.local_positions, t * joints + j)) ==
            clip.skeleton.rest_offsets[j]);
    }
    const Vec3 root = vec3(clip.frames.local_positions, t * joints);
    CHECK((root - person.truth.place[t].cast<double>()).norm() < 0.1);
  }
}
