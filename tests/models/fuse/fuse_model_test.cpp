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

TEST_CASE("the body stands where the Kinect's joints lie; few joints leave the network's place") {
  FusePerson person = fuse_person(20);
  const std::size_t joints = person.input.kinect.joints;
  for (std::size_t j = 7; j < joints; ++j) person.input.kinect.seen[10 * joints + j] = 0;
  FuseModel model = random_fuse_model(3);
  model.smoothing = false;
  auto fuser = Fuser::make(model);
  REQUIRE(fuser);
  const std::vector<HeadingState> headings(20 * 5);
  const FusedPose pose = fuser->solve(person.input, headings);
  CHECK(pose.place[10] == fuser->answer(person.input).place[10]);
  const auto about_root =
      bone_positions(model.body, model.body.skeleton.rest_offsets, pose.rotations);
  const auto& names = model.body.skeleton.joint_names;
  for (std::size_t t = 0; t < 20; ++t) {
    if (t == 10) continue;
    CAPTURE(t);
    for (Eigen::Index k = 0; k < 3; ++k) {
      std::vector<float> ways;
      for (std::size_t j = 0; j < joints; ++j) {
        const auto own = static_cast<std::size_t>(
            std::find(names.begin(), names.end(), fuse_joints[j].body) - names.begin());
        const Eigen::Map<const Eigen::Vector3f> at(&about_root[3 * (t * names.size() + own)]);
        const Eigen::Vector3f in_world = pose.place[t] + pose.root[t] * Eigen::Vector3f(at);
        ways.push_back(
            person.input.kinect.positions[3 * (t * joints + j) + static_cast<std::size_t>(k)] -
            in_world[k]);
      }
      std::sort(ways.begin(), ways.end());
      CHECK(std::abs(ways[joints / 2]) < 1e-5F);
    }
  }
}
