// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/projection.h"

#include "tests/models/bodies.h"

#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/methods/methods.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

constexpr std::size_t ankle_left = 14, foot_left = 15, ankle_right = 18, foot_right = 19;

/// A person whose feet stand still while the trunk turns by half a degree a frame and waves.
JointFrames standing(std::size_t frames) {
  JointFrames out = moving_body(frames, 1);
  for (std::size_t t = 0; t < frames; ++t) {
    const auto row = out.positions.begin() + static_cast<std::ptrdiff_t>(t * 63);
    std::vector<float> one(row, row + 63);
    turn_and_move(one, 0.009 * static_cast<double>(t), {0.3F, 0.0F, 2.0F});
    for (const std::size_t j : {ankle_left, foot_left, ankle_right, foot_right}) {
      for (std::size_t k = 0; k < 3; ++k)
        one[3 * j + k] = standing_body[j][k] + (k == 2 ? 2.0F : 0.0F);
    }
    std::copy(one.begin(), one.end(), row);
  }
  return out;
}

/// A model of the method after only two training steps, so its answer violates the constraints.
DenoiseModel hasty_model(DenoiseMethod method) {
  method.training.batch = 2;
  method.training.crop = 16;
  Pair pair;
  pair.input = standing(40);
  pair.truth = moving_body(40, 2).positions;
  pair.valid.assign(40 * 21, 1);
  const Pairs about{
      .inputs = body_joint_names(), .outputs = body_joint_names(), .rate_hz = 30.0, .all = {}};
  const FitOptions options{{.steps = 2, .rate = 1e-3}, torch::kCPU};
  return fit_denoise(method, about, {{pair}, {}}, options, {}, {})->model;
}

/// Root mean square of the moves of all four foot joints from frame to frame, cm.
double foot_moves(const std::vector<float>& positions) {
  double sum = 0.0, count = 0.0;
  for (std::size_t t = 1; 63 * t < positions.size(); ++t) {
    for (const std::size_t j : {ankle_left, foot_left, ankle_right, foot_right}) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double move =
            100.0 * (positions[63 * t + 3 * j + k] - positions[63 * t - 63 + 3 * j + k]);
        sum += move * move;
      }
      ++count;
    }
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("standing frames: slow, near the floor, four or more") {
  std::vector<float> foot;
  const auto stay = [&](int frames, float x, float y) {
    for (int i = 0; i < frames; ++i) foot.insert(foot.end(), {x, y, 0.0F});
  };
  stay(10, 0.0F, 0.05F);                                                       // stands
  for (int i = 1; i <= 5; ++i) stay(1, 0.05F * static_cast<float>(i), 0.05F);  // 1.5 m/s
  stay(10, 0.25F, 0.20F);  // it rests 15 cm above the floor
  stay(3, 0.25F, 0.05F);   // the rest is too brief, and the joint falls meanwhile
  stay(1, 0.50F, 0.05F);
  const auto found = standing_frames(foot, 30.0);
  CHECK(std::count(found.begin(), found.begin() + 10, 1) == 10);
  CHECK(std::count(found.begin() + 10, found.end(), 1) == 0);
  CHECK(standing_frames({}, 30.0).empty());
}

TEST_CASE("projection: without a step it is what the program answers") {
  for (const DenoiseMethod& method : {cnn_method(), cnn_manifold_method()}) {
    CAPTURE(method.name);
    const DenoiseModel model = hasty_model(method);
    const JointFrames body = standing(31);
    const auto projected = project(model, body, {.steps = 0});
    REQUIRE(projected);
    const auto wanted = Denoiser::make(model)->answer(body).positions;
    REQUIRE(projected->answer.positions.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      CHECK(projected->answer.positions[i] == doctest::Approx(wanted[i]).epsilon(1e-5));
    }
  }
}

TEST_CASE("projection: feet that stand in the input slide less, bones keep their lengths better") {
  const DenoiseModel model = hasty_model(cnn_method());
  const JointFrames body = standing(60);
  const auto plain = project(model, body, {.steps = 0});
  const auto projected = project(model, body);
  REQUIRE(plain);
  REQUIRE(projected);
  // All four foot joints stand in all frames, so only the moves of the joints in the world count.
  CHECK(projected->before.feet_cm ==
        doctest::Approx(foot_moves(plain->answer.positions)).epsilon(1e-3));
  CHECK(projected->after.feet_cm ==
        doctest::Approx(foot_moves(projected->answer.positions)).epsilon(1e-3));
  CHECK(projected->after.feet_cm < 0.5 * projected->before.feet_cm);
  CHECK(projected->after.bone_cm < projected->before.bone_cm);
  CHECK(projected->before.path_cm == 0.0);
  CHECK(projected->after.path_cm < 1.0);
  CHECK(project(model, body)->answer.positions == projected->answer.positions);
}

TEST_CASE("projection: a skeleton without bones or feet is answered with numbers") {
  DenoiseModel model = hasty_model(cnn_method());
  model.layout.parents.assign(21, -1);
  for (std::string& name : model.layout.outputs) name += " of a robot";
  const auto projected = project(model, standing(20));
  REQUIRE(projected);
  for (const float value : projected->answer.positions) CHECK(std::isfinite(value));
}

TEST_CASE("projection: one frame has nothing to slide, a network without a code is refused") {
  const DenoiseModel model = hasty_model(cnn_method());
  REQUIRE(project(model, standing(1)));
  CHECK(project(model, standing(1))->answer.positions.size() == 63);
  const auto refused = project(hasty_model(refine_method()), standing(10));
  REQUIRE_FALSE(refused);
  CHECK(to_string(refused.error()) ==
        "expected a model whose network has a hidden space, such as a cnn model, found a model of "
        "refine");
}
