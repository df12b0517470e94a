// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_model.h"

#include "tests/models/fuse/fuse_people.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// A causal network of random weights.
FuseModel random_fuse_model(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  FuseModel out;
  out.facts = {"fuse", "test", "", "", ""};
  out.layout = fuse_test_layout();
  out.body = pose_body(test_offsets());
  const std::size_t in = out.layout.channels(), answers = out.layout.answers();
  out.input_mean.assign(in, 0.1F);
  out.input_scale.assign(in, 0.9F);
  out.architecture = {in, {{.kind = LayerKind::conv, .out = answers, .kernel = 3, .causal = true}}};
  std::uniform_real_distribution<float> weight(-0.03F, 0.03F);
  Tensor weights{{answers, in, 3}, {}}, bias{{answers}, {}};
  for (std::size_t i = 0; i < answers * in * 3; ++i) weights.values.push_back(weight(random));
  for (std::size_t i = 0; i < answers; ++i) bias.values.push_back(weight(random));
  out.tensors = {{"net.0.weight", weights}, {"net.0.bias", bias}};
  return out;
}

std::string refusal_of(const FuseModel& model) {
  const auto again = read_fuse_model(write_fuse_model(model), "m");
  return again ? "none" : to_string(again.error());
}

FuseInput frame_of(const FuseInput& input, std::size_t t) {
  const auto rows = [&](const auto& from, std::size_t width, auto& to) {
    to.assign(from.begin() + static_cast<std::ptrdiff_t>(t * width),
              from.begin() + static_cast<std::ptrdiff_t>((t + 1) * width));
  };
  FuseInput out;
  const std::size_t nodes = input.nodes.nodes, joints = input.kinect.joints;
  out.nodes.nodes = nodes;
  out.kinect.joints = joints;
  rows(input.nodes.orientation, 4 * nodes, out.nodes.orientation);
  rows(input.nodes.acceleration, 3 * nodes, out.nodes.acceleration);
  rows(input.nodes.angular_velocity, 3 * nodes, out.nodes.angular_velocity);
  rows(input.nodes.valid, nodes, out.nodes.valid);
  rows(input.kinect.positions, 3 * joints, out.kinect.positions);
  rows(input.kinect.seen, joints, out.kinect.seen);
  return out;
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

TEST_CASE("frame by frame the fused answers are those with the headings of the frames so far") {
  const FusePerson person = fuse_person(40);
  auto fuser = Fuser::make(random_fuse_model(2));
  REQUIRE(fuser);
  auto online = OnlineFuser::make(*fuser);
  REQUIRE(online);
  const FuseModel& model = fuser->model();
  HeadingFilter filter(model.layout, model.body);
  FuseInput alone = person.input;
  lose_all(alone.nodes.valid);
  const FusedPose seen = fuser->answer(alone);
  const auto directions =
      directions_of_pose(filter, person.input.kinect, seen.rotations, seen.root);
  FuseInput corrected_input = person.input;
  for (std::size_t t = 0; t < 40; ++t) {
    filter.step(person.input.nodes, t, std::span(directions).subspan(5 * t, 5));
    std::vector<HeadingState> states;
    for (std::size_t n = 0; n < 5; ++n) states.push_back(filter.state(n));
    correct_frame(corrected_input.nodes, t, states);
  }
  FusedPose whole = fuser->answer(corrected_input);
  const auto bones = seen_bones(model.body, model.layout.joints);
  const auto carried = carried_bones(model.layout, model.body);
  for (std::size_t t = 0; t < 40; ++t) {
    const auto rotations =
        std::span(whole.rotations).subspan(t * pose_bones.size(), pose_bones.size());
    turn_to_nodes(carried, corrected_input.nodes, t, whole.root[t], rotations);
    turn_to_seen(bones, person.input.kinect, t, whole.root[t], rotations);
  }
  for (int round = 0; round < 2; ++round) {
    for (std::size_t t = 0; t < 40; ++t) {
      const auto turns = online->step(frame_of(person.input, t));
      for (std::size_t b = 0; b < turns.size(); ++b) {
        REQUIRE((turns[b] - whole.rotations[t * turns.size() + b]).norm() < 1e-5F);
      }
      REQUIRE(online->frame().root.angularDistance(whole.root[t]) < 1e-3F);
      REQUIRE((online->frame().place - whole.place[t]).norm() < 1e-5F);
    }
    online->reset();
  }
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
