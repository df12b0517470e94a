// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/fit_pose.h"

#include "tests/learn/pose/swinging.h"

#include "kinalign/learn/tensors.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace kinalign;

namespace {

/// A method that trains on one window only.
PoseMethod one_window(PoseMethod method) {
  method.training.errors = no_node_errors();
  method.training.variety = no_variety;
  method.training.batch = 1;
  method.training.crop = 24;
  return method;
}

FitOptions options(std::int64_t steps) {
  return {.training = {.steps = steps, .rate = 2e-3, .average = false}};
}

}  // namespace

TEST_CASE("rotations and positions on tensors are those of infer's side") {
  std::mt19937_64 random(1);
  const PoseData data = swinging_data();
  const PoseTask task(test_layout(), {}, data, torch::kCPU);
  const auto six = torch::randn({2, 3, 90});
  const auto rotations = rotations_of(six);
  std::vector<float> offsets;
  for (int k = 0; k < 2; ++k) {
    for (const Vec3& offset : test_offsets()) {
      for (const double value : offset) offsets.push_back(static_cast<float>(value));
    }
  }
  const auto places = values_of(
      BodyTensors(data.body, torch::kCPU).places_of(rotations, to_torch(offsets, {2, 27, 3})));
  const auto numbers = values_of(six);
  std::vector<Turn> turns;
  for (std::size_t at = 0; at < numbers.size(); at += 6) {
    std::array<float, 6> one = six_of_identity;
    for (std::size_t k = 0; k < 6; ++k) one[k] += numbers[at + k];
    turns.push_back(turn_of_six(one.data()));
  }
  const auto values = values_of(rotations);
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(std::abs(values[i] - turns[i / 9].data()[i % 9]) < 2e-5F);
  }
  const auto positions = bone_positions(data.body, data.body.skeleton.rest_offsets, turns);
  std::size_t next = 0;
  for (std::size_t i = 0; i < positions.size() / 3; ++i) {
    if (!is_scored_joint(data.body.skeleton.joint_names[i % 27])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(places[next++] - positions[3 * i + k]) < 2e-5F);
    }
  }
  CHECK(next == places.size());
}

TEST_CASE("what is learnt is what runs: every method's network to 1e-5") {
  std::mt19937_64 random(2);
  const NodeFrames nodes = random_nodes(5, 50, random);
  for (const PoseMethod& method : pose_methods()) {
    CAPTURE(method.name);
    torch::manual_seed(3);
    PoseLayout layout = test_layout();
    layout.inputs = method.inputs;
    const TorchNetwork network(method.architecture(layout));
    PoseModel model;
    model.layout = layout;
    model.body = pose_body(test_offsets());
    model.input_mean.assign(layout.channels(), 0.0F);
    model.input_scale.assign(layout.channels(), 1.0F);
    model.architecture = network.architecture();
    put_tensors(network, "net.", model.tensors);
    auto solver = PoseSolver::make(model);
    REQUIRE(solver);
    const auto runs = solver->answer(nodes).rotations;
    torch::NoGradGuard guard;
    const auto input =
        to_torch(pose_features(layout, nodes).input, {1, 50, whole(layout.channels())});
    const auto learnt = values_of(rotations_of(network.forward(input, false)));
    REQUIRE(learnt.size() == 9 * runs.size());
    float worst = 0.0F;
    for (std::size_t i = 0; i < learnt.size(); ++i) {
      worst = std::max(worst, std::abs(learnt[i] - runs[i / 9].data()[i % 9]));
    }
    CHECK(worst < 1e-5F);
  }
}

TEST_CASE("one window is learnt by heart") {
  torch::globalContext().setFlushDenormal(true);  // kinalign-learn sets it too
  for (const PoseMethod& method : {inertial_method(), dip_method()}) {
    CAPTURE(method.name);
    PoseMethod alone = one_window(method);
    const PoseData data = swinging_data();
    PoseLayout layout = test_layout();
    layout.inputs = method.inputs;
    PoseTask task(layout, alone.training, data, torch::kCPU);
    torch::manual_seed(1);
    Architecture architecture = method.architecture(layout);
    without_dropout(architecture.layers);
    TorchNetwork network(architecture);
    const double before = task.loss(network, 1, 0).item<double>();
    REQUIRE(train(network, task, options(150).training, {}, {}));
    CHECK(task.loss(network, 1, 0).item<double>() < 0.05 * before);
    for (const auto& [name, tensor] : network.tensors()) {
      CHECK(torch::isfinite(tensor.grad()).all().item<bool>());
    }
  }
}

TEST_CASE("the same seed gives the same model, another one another") {
  const PoseData data = swinging_data();
  PoseMethod method = inertial_method();
  method.training.batch = 4;
  const auto fitted = [&](std::uint64_t seed) {
    FitOptions how = options(4);
    how.training.seed = seed;
    const auto fit = fit_pose(method, data, how, {}, {});
    REQUIRE(fit);
    return write_pose_model(fit->model);
  };
  CHECK(fitted(1) == fitted(1));
  CHECK(fitted(1) != fitted(2));
}

TEST_CASE("ridge regression explains what its nodes show") {
  const PoseData data = swinging_data();
  PoseMethod method = one_window(wouda_method());
  const auto fit = fit_pose(method, data, options(0), {}, {});
  REQUIRE(fit);
  auto solver = PoseSolver::make(fit->model);
  REQUIRE(solver);
  const PoseSequence& one = data.learnt[0];
  const TruePose truth{one.rotations, one.rest_offsets};
  const std::vector<Turn> still(one.rotations.size(), Turn::Identity());
  const auto answer = solver->answer(one.nodes).rotations;
  const double nothing = pose_errors(data.body, still, truth, 30.0).position_cm;
  CHECK(pose_errors(data.body, answer, truth, 30.0).position_cm < 0.2 * nothing);
  REQUIRE(fit->points.size() == 1);
  CHECK(fit->points[0].judgement.has_value());
}
