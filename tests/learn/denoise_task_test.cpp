// SPDX-License-Identifier: Apache-2.0
// The methods that clean skeletons, trained on one short pair.
#include "kinalign/learn/denoise_task.h"

#include "tests/models/bodies.h"

#include "kinalign/learn/clean_motion.h"
#include "kinalign/learn/fit_denoise.h"
#include "kinalign/learn/methods/methods.h"
#include "kinalign/models/denoise_model.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace kinalign;

namespace {

/// A rough motion and its truth: the truth has other waves about the same body.
Pair one_pair(std::size_t frames) {
  Pair out;
  out.input = moving_body(frames, 1);
  out.truth = moving_body(frames, 2).positions;
  out.valid.assign(frames * standing_body.size(), 1);
  out.take = "S01-A1";
  out.part = "train";
  return out;
}

DenoiseLayout layout_of(const DenoiseMethod& method) {
  DenoiseLayout out = *denoise_layout(body_joint_names(), body_joint_names(), 30.0);
  if (!method.from_base) out.bases.assign(out.outputs.size(), -1);
  return out;
}

void narrow(std::vector<Layer>& layers, std::size_t wide, std::size_t width) {
  for (Layer& one : layers) {
    one.rate = 0.0;
    if (one.out == wide) one.out = width;
    for (auto& branch : one.branches) narrow(branch, wide, width);
  }
}

/// The method's network with few channels and without dropout.
Architecture narrow_network(const DenoiseMethod& method, const DenoiseLayout& layout) {
  Architecture out = method.architecture(layout);
  for (const std::size_t wide : {128U, 256U}) narrow(out.layers, wide, 48);
  return out;
}

/// The method's training for small tests: batches of two, no mirror images, and no smoothness loss.
DenoiseTraining small_training(const DenoiseMethod& method) {
  DenoiseTraining out = method.training;
  out.batch = 2;
  out.mirror = false;
  out.loss.smooth = 0.0;  // it holds the answer back, whatever the truth is
  return out;
}

/// The pair. For a method that learns from the truth alone, the input is the truth, too.
Pair pair_for(const DenoiseMethod& method) {
  Pair out = one_pair(static_cast<std::size_t>(method.training.crop));
  if (method.training.from_truth) out.truth = out.input.positions;
  return out;
}

void answer_zeros(TorchNetwork& network) {
  for (auto& [name, tensor] : network.tensors()) tensor.detach().zero_();
}

/// The judgement after the fit, as a share of that of the untrained network.
double left_over(const DenoiseMethod& method, std::int64_t steps) {
  const DenoiseLayout layout = layout_of(method);
  const std::vector<Pair> pairs{pair_for(method)};
  DenoiseTask task(layout, small_training(method), pairs, pairs, torch::kCPU);
  torch::manual_seed(1);
  TorchNetwork network(narrow_network(method, layout));
  const double before = *task.judge(network);
  begin_network(method, task, network);
  REQUIRE(train(network, task, {.steps = steps, .rate = 1e-2, .average = false}, {}, {}));
  const double after = *task.judge(network);
  MESSAGE(std::string(method.name), ": ", before, " to ", after);
  return after / before;
}

Pairs pairs_about() {
  return {.inputs = body_joint_names(), .outputs = body_joint_names(), .rate_hz = 30.0, .all = {}};
}

/// A model of the method at its full width, after two steps.
Result<DenoiseFit> fitted(DenoiseMethod method, std::uint64_t seed) {
  method.training.batch = 2;
  method.training.crop = 16;
  const FitOptions options{{.steps = 2, .rate = 1e-3, .seed = seed}, torch::kCPU};
  return fit_denoise(method, pairs_about(), {{one_pair(64)}, {}}, options, {}, {});
}

}  // namespace

TEST_CASE("denoise task: each network learns one window by heart") {
  CHECK(left_over(refine_method(), 300) < 0.05);
  CHECK(left_over(refine_linear_method(), 300) < 0.05);
  // Its pools join two frames each; with the processor's rounding it ends at 0.05 to 0.09.
  CHECK(left_over(cnn_method(), 1000) < 0.12);
  CHECK(left_over(bra_method(), 400) < 0.05);
  CHECK(left_over(cnn_manifold_method(), 1000) < 0.05);
  CHECK(left_over(smoothnet_method(), 3000) < 0.05);
}

TEST_CASE("denoise task: manifold mode learns from the truth, whatever the Kinect saw") {
  const auto loss = [](const DenoiseMethod& method, const Pair& pair) {
    const DenoiseLayout layout = layout_of(method);
    DenoiseTask task(layout, small_training(method), {pair}, {}, torch::kCPU);
    torch::manual_seed(1);
    torch::NoGradGuard guard;
    return task.loss(TorchNetwork(narrow_network(method, layout)), 1, 0).item<double>();
  };
  const Pair pair = one_pair(61);
  Pair rough = pair;
  for (std::size_t t = 0; t < 61; ++t) {  // a wrist, which does not turn the body's frame
    rough.input.positions[63 * t + 3 * 6] += 0.2F * std::sin(0.3F * static_cast<float>(t));
  }
  CHECK(loss(cnn_manifold_method(), rough) ==
        doctest::Approx(loss(cnn_manifold_method(), pair)).epsilon(1e-5));
  CHECK(loss(cnn_method(), rough) != doctest::Approx(loss(cnn_method(), pair)).epsilon(1e-5));
}

TEST_CASE("denoise task: SmoothNet smooths each channel alone") {
  const DenoiseMethod method = smoothnet_method();
  const DenoiseLayout layout = layout_of(method);
  torch::manual_seed(1);
  torch::NoGradGuard guard;
  const TorchNetwork network(method.architecture(layout));
  const std::int64_t channels = static_cast<std::int64_t>(layout.channels());
  const auto input = torch::randn({1, 50, channels});
  auto other = input.clone();
  other.select(2, 7) += 1.0;  // y of joint 2
  const auto moved = (network.forward(other, false) - network.forward(input, false)).abs().sum(1);
  for (std::int64_t c = 0; c < moved.size(1); ++c) {
    CHECK((moved[0][c].item<double>() > 1e-3) == (c == 7));
  }
}

TEST_CASE("denoise task: a weight of the hands counts their errors so many times") {
  const DenoiseMethod method = refine_method();
  const DenoiseLayout layout = layout_of(method);
  Pair still = one_pair(61);
  for (std::size_t i = 0; i < still.truth.size(); ++i) {
    still.input.positions[i] = still.truth[i] = standing_body[i / 3 % 21][i % 3];
  }
  // The joint is 10 cm off to one side and then to the other, so its mean error is zero.
  const auto loss = [&](std::size_t joint, double hands) {
    Pair wrong = still;
    for (std::size_t t = 0; t < 60; ++t) wrong.truth[63 * t + 3 * joint] += t < 30 ? 0.1F : -0.1F;
    DenoiseTraining training = small_training(method);
    training.loss = {.distance = 1.0, .acceleration = 0.0, .bone = 0.0, .spread = 0.0};
    training.loss.hands = hands;
    training.states_spread = false;
    DenoiseTask task(layout, training, {wrong}, {}, torch::kCPU);
    TorchNetwork network(narrow_network(method, layout));
    answer_zeros(network);
    torch::NoGradGuard guard;
    return task.loss(network, 1, 0).item<double>();
  };
  constexpr std::size_t wrist = 6, knee = 13;
  CHECK(loss(wrist, 1.0) == doctest::Approx(loss(knee, 1.0)).epsilon(0.01));
  CHECK(loss(wrist, 3.0) == doctest::Approx(3.0 * loss(knee, 3.0)).epsilon(0.03));
  // 4 of 21 joints are hands, and the weights keep a mean of 1.
  CHECK(loss(knee, 3.0) == doctest::Approx(loss(knee, 1.0) * 21.0 / (17.0 + 12.0)).epsilon(0.01));
}

TEST_CASE("denoise task: forty fingers count as one joint of each hand") {
  std::vector<std::string> outputs = body_joint_names();
  std::vector<int> parents(outputs.size(), -1);
  const auto wrist =
      static_cast<int>(std::find(outputs.begin(), outputs.end(), "WristLeft") - outputs.begin());
  const std::size_t own = outputs.size();
  for (int finger = 0; finger < 20; ++finger) {
    outputs.push_back("LeftHandIndex" + std::to_string(finger));
    parents.push_back(wrist);
  }
  const DenoiseLayout layout = *denoise_layout(body_joint_names(), outputs, 30.0, parents);
  const auto loss = [&](std::size_t from, std::size_t to) {  // these joints are 10 cm off
    Pair pair = one_pair(61);
    pair.truth.clear();
    for (std::size_t i = 0; i < pair.input.positions.size(); ++i) {
      pair.input.positions[i] = standing_body[i / 3 % own][i % 3];
    }
    for (std::size_t t = 0; t < 61; ++t) {
      for (std::size_t j = 0; j < outputs.size(); ++j) {
        auto at = standing_body[j < own ? j : static_cast<std::size_t>(wrist)];
        if (j >= from && j < to) at[0] += t < 30 ? 0.1F : -0.1F;
        pair.truth.insert(pair.truth.end(), at.begin(), at.end());
      }
    }
    pair.valid.assign(61 * outputs.size(), 1);
    DenoiseTraining training = small_training(refine_method());
    training.loss = {.distance = 1.0, .acceleration = 0.0, .bone = 0.0, .spread = 0.0};
    training.states_spread = false;
    DenoiseTask task(layout, training, {pair}, {}, torch::kCPU);
    TorchNetwork network(narrow_network(refine_method(), layout));
    answer_zeros(network);
    torch::NoGradGuard guard;
    return task.loss(network, 1, 0).item<double>();
  };
  CHECK(loss(own, outputs.size()) == doctest::Approx(loss(13, 14)).epsilon(0.02));
}

TEST_CASE("denoise task: every gradient is there and finite") {
  for (const DenoiseMethod& method : denoise_methods()) {
    CAPTURE(method.name);
    const DenoiseLayout layout = layout_of(method);
    DenoiseTraining training = small_training(method);
    training.crop = 16;
    DenoiseTask task(layout, training, {one_pair(30)}, {}, torch::kCPU);
    torch::manual_seed(1);
    const TorchNetwork clean(clean_motion_architecture(layout.answers()));
    if (method.perceptual) {
      task.compare_features(
          [&](const torch::Tensor& answers) { return motion_features(clean, answers); });
    }
    TorchNetwork network(method.architecture(layout));
    const auto loss = task.loss(network, 1, 0);
    loss.backward();
    CHECK(std::isfinite(loss.item<double>()));
    for (const auto& [name, tensor] : network.tensors()) {
      CAPTURE(name);
      REQUIRE(tensor.grad().defined());
      CHECK(torch::isfinite(tensor.grad()).all().item<bool>());
    }
  }
}

TEST_CASE("denoise task: the loss of a step depends on seed and step alone") {
  const DenoiseMethod method = refine_method();
  const DenoiseLayout layout = layout_of(method);
  DenoiseTask task(layout, small_training(method), {one_pair(90)}, {}, torch::kCPU);
  torch::manual_seed(1);
  const TorchNetwork network(narrow_network(method, layout));
  const auto loss = [&](std::uint64_t seed, std::uint64_t step) {
    torch::NoGradGuard guard;
    return task.loss(network, seed, step).item<double>();
  };
  const double first = loss(1, 0);
  CHECK(loss(1, 1) != first);
  CHECK(loss(2, 0) != first);
  CHECK(loss(1, 0) == first);
  CHECK_FALSE(task.judge(network));
}

TEST_CASE("denoise task: joints without truth do not count") {
  const DenoiseMethod method = refine_method();
  const DenoiseLayout layout = layout_of(method);
  Pair pair = one_pair(61), wrong = pair;
  for (std::size_t t = 0; t < 61; ++t) {
    const std::size_t at = t * 21 + 7;
    pair.valid[at] = wrong.valid[at] = 0;
    wrong.truth[3 * at] += 5.0F;
  }
  DenoiseTraining training = small_training(method);
  training.states_spread = false;
  const auto loss = [&](const Pair& one) {
    DenoiseTask task(layout, training, {one}, {}, torch::kCPU);
    torch::manual_seed(1);
    torch::NoGradGuard guard;
    return task.loss(TorchNetwork(narrow_network(method, layout)), 1, 0).item<double>();
  };
  // Second differences need whole frames: all 3 frames of the joint are not valid.
  CHECK(loss(pair) == doctest::Approx(loss(wrong)).epsilon(1e-6));
}

TEST_CASE("fit: each method gives a model that is written, read and used") {
  for (const DenoiseMethod& method : denoise_methods()) {
    CAPTURE(method.name);
    auto fit = fitted(method, 1);
    REQUIRE(fit);
    CHECK(fit->model.second.has_value() == method.has_second);
    auto read = read_denoise_model(write_denoise_model(fit->model), "m");
    REQUIRE(read);
    auto denoiser = Denoiser::make(*std::move(read));
    REQUIRE(denoiser);
    const Denoised out = denoiser->clean(moving_body(20, 5));
    CHECK(out.positions.size() == 20 * 63);
    for (const float value : out.positions) CHECK(std::isfinite(value));
    CHECK(out.spread.empty() != method.training.states_spread);
  }
}

TEST_CASE("fit: the same seed gives the same model, byte for byte") {
  const auto bytes = [](std::uint64_t seed) {
    return write_denoise_model(fitted(refine_method(), seed)->model);
  };
  const std::string first = bytes(3);
  CHECK(bytes(3) == first);
  CHECK(bytes(4) != first);
}

TEST_CASE("fit: no pairs, and no whole stretch for the second network of bra-p, are refused") {
  const FitOptions options{{.steps = 2}, torch::kCPU};
  const auto none = fit_denoise(refine_method(), pairs_about(), {}, options, {}, {});
  REQUIRE_FALSE(none);
  CHECK(to_string(none.error()) == "expected pairs to train on, found none");
  const auto brief =
      fit_denoise(bra_p_method(), pairs_about(), {{one_pair(30)}, {}}, options, {}, {});
  REQUIRE_FALSE(brief);
  CHECK(to_string(brief.error()) == "expected stretches of 61 rows of clean motion, found none");
}

TEST_CASE("fit: a model goes on from another one, with its scales, and begins where it stood") {
  auto first = fitted(refine_method(), 3);
  REQUIRE(first);
  const FitOptions none{{.steps = 0}, torch::kCPU};
  const auto again = fit_denoise(refine_method(), pairs_about(), {{one_pair(61)}, {}}, none, {}, {},
                                 &first->model);
  REQUIRE(again);
  for (const auto& [name, tensor] : first->model.tensors) {
    CAPTURE(name);
    CHECK(again->model.tensors.at(name) == tensor);
  }
  CHECK(again->model.input_mean == first->model.input_mean);
  CHECK(again->model.answer_mean == first->model.answer_mean);
  const auto other =
      fit_denoise(cnn_method(), pairs_about(), {{one_pair(61)}, {}}, none, {}, {}, &first->model);
  REQUIRE_FALSE(other);
  CHECK(to_string(other.error())
            .starts_with("expected a model of this method's network, found another network at "));
}
