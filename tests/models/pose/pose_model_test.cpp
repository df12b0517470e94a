// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_model.h"

#include "tests/models/pose/pose_people.h"

#include "kinalign/formats/bvh/bvh.h"
#include "kinalign/models/pose/own_body.h"
#include "kinalign/models/pose/window_solver.h"

#include <doctest/doctest.h>

#include <limits>

using namespace kinalign;

namespace {

/// A causal network with random weights.
PoseModel random_model(std::mt19937_64& random) {
  PoseModel out;
  out.facts = {"pose", "test", "", "", ""};
  out.layout = test_layout();
  out.body = pose_body(test_offsets());
  out.input_mean.assign(out.layout.channels(), 0.1F);
  out.input_scale.assign(out.layout.channels(), 0.9F);
  out.architecture = {
      out.layout.channels(),
      {{.kind = LayerKind::conv, .out = out.layout.answers(), .kernel = 3, .causal = true}}};
  std::uniform_real_distribution<float> weight(-0.05F, 0.05F);
  Tensor weights{{90, 61, 3}, {}}, bias{{90}, {}};
  for (int i = 0; i < 90 * 61 * 3; ++i) weights.values.push_back(weight(random));
  for (int i = 0; i < 90; ++i) bias.values.push_back(weight(random));
  out.tensors = {{"net.0.weight", weights}, {"net.0.bias", bias}};
  return out;
}

std::string refusal(const std::string& bytes) {
  const auto model = read_pose_model(bytes, "m");
  return model ? "none" : to_string(model.error());
}

}  // namespace

TEST_CASE("a model's file is read as it was written") {
  std::mt19937_64 random(1);
  const PoseModel model = random_model(random);
  const std::string bytes = write_pose_model(model);
  const auto again = read_pose_model(bytes, "m");
  REQUIRE(again);
  CHECK(again->layout == model.layout);
  CHECK(again->tensors == model.tensors);
  CHECK(again->body.skeleton.rest_offsets == model.body.skeleton.rest_offsets);
  CHECK(again->body.turned_by == model.body.turned_by);
  CHECK(write_pose_model(*again) == bytes);
}

TEST_CASE("a model whose parts do not fit is refused") {
  std::mt19937_64 random(1);
  const PoseModel model = random_model(random);
  PoseModel other = model;
  other.facts.task = "denoise";
  CHECK(refusal(write_pose_model(other)) ==
        "m: expected a model for poses from inertial nodes, found task denoise");
  other = model;
  other.layout.nodes = {"head", "waist"};
  CHECK(refusal(write_pose_model(other)) == "m: expected 3 to 6 nodes, found 2");
  other = model;
  other.input_scale[3] = 0.0F;
  CHECK(refusal(write_pose_model(other)) ==
        "m: expected input.mean and input.scale of 61 channels, scales above 0, found others");
  other = model;
  other.input_mean[0] = std::numeric_limits<float>::infinity();
  CHECK(refusal(write_pose_model(other)) ==
        "m: expected input.mean and input.scale of 61 channels, scales above 0, found others");
  other = model;
  other.layout.rate_hz = 1e-9;
  CHECK(refusal(write_pose_model(other)) ==
        "m: expected 0.1 to 10,000 frames a second, found 0.000000");
  other = model;
  other.body.skeleton.rest_offsets[3].x() = 1e30;
  CHECK(refusal(write_pose_model(other)) ==
        "m: expected bones of at most 100 m, found a longer bone");
  other = model;
  other.body.skeleton.parents[2] = 9;
  CHECK(refusal(write_pose_model(other)) != "none");
  other = model;
  other.layout.bones.pop_back();
  other.body.bones.pop_back();
  CHECK(refusal(write_pose_model(other)) ==
        "m: expected a bone for each joint below the root, found another list of bones");
  CHECK(refusal("no model") != "none");
}

TEST_CASE("a network of other channels is refused") {
  std::mt19937_64 random(1);
  PoseModel model = random_model(random);
  model.layout.inputs = PoseInputs::dip;
  CHECK(to_string(PoseSolver::make(model).error()) ==
        "expected 48 channels in and 90 out, found 61 and 90");
}

TEST_CASE("a window that sees all that the network sees answers as the whole sequence does") {
  std::mt19937_64 random(2);
  for (const bool causal : {false, true}) {
    CAPTURE(causal);
    PoseModel model = random_model(random);
    model.architecture.layers.front().causal = causal;
    auto solver = PoseSolver::make(model);
    REQUIRE(solver);
    NodeFrames nodes = random_nodes(5, 40, random);
    nodes.valid[7] = nodes.valid[5 * 20 + 4] = 0;
    const SolvedPose whole = solver->solve(nodes);
    WindowSolver window(*solver, 100);
    CHECK(window.look_ahead() == (causal ? 2 : 3));  // smoothing sees two frames, the network one
    std::vector<FramePose> answers;
    for (std::size_t t = 0; t < nodes.frames(); ++t) {
      if (auto pose = window.step(nodes, t)) answers.push_back(*std::move(pose));
      CHECK(answers.size() == t + 1 - std::min(t + 1, window.look_ahead()));
    }
    while (auto pose = window.finish()) answers.push_back(*std::move(pose));
    REQUIRE(answers.size() == nodes.frames());
    for (std::size_t t = 0; t < answers.size(); ++t) {
      for (std::size_t b = 0; b < answers[t].rotations.size(); ++b) {
        CHECK(answers[t].rotations[b] == whole.rotations[t * answers[t].rotations.size() + b]);
      }
      CHECK(answers[t].root.coeffs() == whole.root[t].coeffs());
    }
  }
}

TEST_CASE("smoothing leaves a pose that does not move, and rotations are rotations") {
  std::mt19937_64 random(3);
  const Turn one = random_turn(random).toRotationMatrix();
  std::vector<Turn> still(8, one);
  smooth_turns(2, still);
  for (const Turn& turn : still) CHECK((turn - one).norm() < 1e-5F);
  auto solver = PoseSolver::make(random_model(random));
  REQUIRE(solver);
  const SolvedPose pose = solver->solve(random_nodes(5, 20, random));
  for (const Turn& turn : pose.rotations) {
    CHECK((turn * turn.transpose() - Turn::Identity()).norm() < 1e-4F);
  }
}

TEST_CASE("a clip has the body that was asked for, with constant bones") {
  std::mt19937_64 random(4);
  auto solver = PoseSolver::make(random_model(random));
  REQUIRE(solver);
  const Skeleton longer = scaled(pose_body(test_offsets()).skeleton, 1.1);
  solver->use_body(longer);
  const Clip clip = solver->clip(random_nodes(5, 4, random), Time{});
  CHECK(validate(clip.skeleton));
  for (std::size_t j = 1; j < clip.skeleton.joints(); ++j) {
    CHECK(vec3(clip.frames.local_positions, 3 * clip.skeleton.joints() + j) ==
          longer.rest_offsets[j]);
  }
}

TEST_CASE("a pose is written as BVH, and its skeleton is read again") {
  std::mt19937_64 random(5);
  auto solver = PoseSolver::make(random_model(random));
  REQUIRE(solver);
  const Clip clip = solver->clip(random_nodes(5, 4, random), Time{});
  std::string text;
  const auto sink = [&](std::string_view bytes) -> Result<void> {
    text += bytes;
    return {};
  };
  REQUIRE(write_bvh(bvh_from_clip(clip, 1.0 / 30.0), sink));
  const auto file = read_bvh(text, "pose.bvh", BvhOptions{});
  REQUIRE(file);
  CHECK(file->clip.skeleton.joint_names == clip.skeleton.joint_names);
  CHECK(file->clip.skeleton.parents == clip.skeleton.parents);
  // The file has six decimals of degrees and of centimetres.
  for (std::size_t i = 0; i < 4 * clip.skeleton.joints(); ++i) {
    const Quat a = quat(clip.frames.local_rotations, i);
    CHECK(a.angularDistance(quat(file->clip.frames.local_rotations, i)) < 1e-7);
  }
}
