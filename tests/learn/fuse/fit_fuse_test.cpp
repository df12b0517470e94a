// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fit_fuse.h"

#include "tests/learn/fuse/fuse_swinging.h"

#include "kinalign/learn/fuse/fuse_marks.h"
#include "kinalign/learn/tensors.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

FuseMethod small(FuseMethod method) {
  method.training.batch = 2;
  method.training.crop = 32;
  return method;
}

FitOptions fuse_options(std::int64_t steps, std::uint64_t seed = 1) {
  return {.training = {.steps = steps, .rate = 2e-3, .average = false, .seed = seed}};
}

}  // namespace

TEST_CASE("what fusion learns is what runs: every method's network to 1e-5") {
  const FuseData data = swinging_before_kinect();
  const FuseLayout layout = fuse_layout(data);
  const FuseInput input{data.pose.learnt[0].nodes, data.learnt[0][0]};
  for (const FuseMethod& method : fuse_methods()) {
    CAPTURE(method.name);
    torch::manual_seed(3);
    const TorchNetwork network(method.architecture(layout));
    FuseModel model;
    model.layout = layout;
    model.body = data.pose.body;
    model.input_mean.assign(layout.channels(), 0.0F);
    model.input_scale.assign(layout.channels(), 1.0F);
    model.architecture = network.architecture();
    put_tensors(network, "net.", model.tensors);
    auto fuser = Fuser::make(model);
    REQUIRE(fuser);
    const FusedPose runs = fuser->answer(input);
    torch::NoGradGuard guard;
    const auto features = fuse_features(layout, input);
    const std::int64_t frames = whole(input.frames());
    const auto answers = values_of(
        network.forward(to_torch(features.input, {1, frames, whole(layout.channels())}), false));
    std::vector<Turn> turns(layout.nodes.bones.size());
    for (std::size_t t = 0; t < input.frames(); ++t) {
      const FusedFrame frame =
          fused_frame(features.space[t],
                      std::span(answers).subspan(t * layout.answers(), layout.answers()), turns);
      for (std::size_t b = 0; b < turns.size(); ++b) {
        REQUIRE((turns[b] - runs.rotations[t * turns.size() + b]).norm() < 3e-5F);
      }
      REQUIRE((frame.place - runs.place[t]).norm() < 1e-5F);
      REQUIRE(frame.root.angularDistance(runs.root[t]) < 1e-3F);
    }
  }
}

TEST_CASE("the truth of a batch is the pose in the space of each frame") {
  const FuseData data = swinging_before_kinect();
  const FuseLayout layout = fuse_layout(data);
  FuseTraining training;
  training.batch = 1;
  training.crop = 64;
  training.variety = no_variety;
  training.draws = {.errors = no_node_errors(),
                    .unknown_heading = 0.0,
                    .without_kinect = 0.0,
                    .without_nodes = 0.0,
                    .lost_part = 0.0};
  const FuseTask task(layout, training, data, torch::kCPU);
  const auto batch = task.draw(1, 0);
  // With clean nodes the space is the root's own, and the root's rotation in it is the identity.
  const auto turns = turns_of(batch.rotations);
  const std::size_t bones = layout.nodes.bones.size();
  for (std::size_t t = 0; t < 64; ++t) {
    CHECK((turns[t * (bones + 1) + bones] - Turn::Identity()).norm() < 1e-5F);
    for (std::size_t b = 0; b < bones; ++b) {
      CHECK((turns[t * (bones + 1) + b] - data.pose.learnt[0].rotations[t * bones + b]).norm() <
            1e-5F);
    }
  }
  // The offset from the Kinect's SpineBase leads to the root.
  const auto way = values_of(batch.way);
  for (std::size_t t = 0; t < 64; ++t) {
    if (data.learnt[0][0].seen[t * layout.joints.size()] == 0) continue;
    const float* base = &data.learnt[0][0].positions[3 * t * layout.joints.size()];
    const Eigen::Vector3f off(way[3 * t], way[3 * t + 1], way[3 * t + 2]);
    const Eigen::Vector3f root = data.pose.learnt[0].places[t].cast<float>();
    CHECK((Eigen::Map<const Eigen::Vector3f>(base) + fuse_place_unit_m * off - root).norm() <
          1e-5F);
  }
}

TEST_CASE("nodes alone are judged by the way their root looks") {
  const FuseData data = swinging_before_kinect();
  const FuseLayout layout = fuse_layout(data);
  FuseTraining training;
  training.batch = 1;
  training.crop = 64;
  training.variety = no_variety;
  training.draws.devices = Devices::nodes;
  training.draws.errors = no_node_errors();
  training.draws.errors.yaw_deg = 90.0;
  training.draws.unknown_heading = training.draws.lost_part = 0.0;
  const FuseTask task(layout, training, data, torch::kCPU);
  const auto turns = turns_of(task.draw(1, 0).rotations);
  const std::size_t bones = layout.nodes.bones.size();
  CHECK((turns[bones] - Turn::Identity()).norm() < 1e-4F);
}

TEST_CASE("one window of both devices is learnt by heart") {
  torch::globalContext().setFlushDenormal(true);
  const FuseData data = swinging_before_kinect(32);
  const FuseLayout layout = fuse_layout(data);
  for (const FuseMethod& method : {gated_method(), bilstm_method(Devices::both)}) {
    CAPTURE(method.name);
    FuseTraining training = small(method).training;
    training.variety = no_variety;
    training.draws = {.errors = no_node_errors(),
                      .unknown_heading = 0.0,
                      .without_kinect = 0.0,
                      .without_nodes = 0.0,
                      .lost_part = 0.0};
    FuseTask task(layout, training, data, torch::kCPU);
    torch::manual_seed(1);
    Architecture architecture = method.architecture(layout);
    without_dropout(architecture.layers);
    TorchNetwork network(architecture);
    const double before = task.loss(network, 1, 0).item<double>();
    REQUIRE(train(network, task, fuse_options(150).training, {}, {}));
    CHECK(task.loss(network, 1, 0).item<double>() < 0.06 * before);
    for (const auto& [name, tensor] : network.tensors()) {
      CHECK(torch::isfinite(tensor.grad()).all().item<bool>());
    }
  }
}

TEST_CASE("the same seed gives the same fusing model, another one another") {
  const FuseData data = swinging_before_kinect();
  const auto fitted = [&](std::uint64_t seed) {
    const auto fit = fit_fuse(small(gated_method()), data, fuse_options(3, seed), {}, {});
    REQUIRE(fit);
    return write_fuse_model(fit->model);
  };
  CHECK(fitted(1) == fitted(1));
  CHECK(fitted(1) != fitted(2));
}

TEST_CASE("a fusion that answers with the truth has no error") {
  const FuseData data = swinging_before_kinect(128);
  const PoseSequence& truth = data.pose.tested[0];
  const Fusion perfect = [&](const FuseInput&) {
    FusedPose out{truth.rotations, true_roots(truth), {}};
    for (const Vec3& place : truth.places) out.place.push_back(place.cast<float>());
    return out;
  };
  const auto marks = fuse_marks(perfect, fuse_layout(data), data,
                                {Devices::both, Devices::kinect, Devices::nodes});
  REQUIRE(marks);
  for (const FuseMark& mark : *marks) {
    CHECK(mark.all.all_cm < 1e-3);
    CHECK(mark.all.hidden_cm < 1e-3);
    CHECK(mark.all.hidden > 0);
    CHECK(mark.all.sip_deg < 0.1);
    REQUIRE(mark.people.size() == 1);
    CHECK(mark.people.begin()->second.hidden == mark.all.hidden);
  }
}
