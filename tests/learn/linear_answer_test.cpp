// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/linear_answer.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

/// [T,C] noise, and its convolution.
struct Convolved {
  torch::Tensor input, weight, bias, target;
};

Convolved convolved(std::int64_t frames) {
  torch::manual_seed(1);
  Convolved out{torch::randn({frames, 6}), torch::randn({2, 6, 5}), torch::randn({2}), {}};
  const auto answer = torch::conv1d(out.input.t().unsqueeze(0), out.weight, out.bias, 1, 2);
  out.target = answer[0].t();
  return out;
}

}  // namespace

TEST_CASE("linear answer: a convolution is found again, from several takes") {
  const Convolved data = convolved(400);
  LinearFit fit(6, 2, 5);
  const auto all = torch::ones({400}, torch::kBool);
  fit.add(data.input, data.target, all);
  const LinearAnswer found = fit.solved(1e-9);
  CHECK((found.weight - data.weight).abs().max().item<double>() < 1e-5);
  CHECK((found.bias - data.bias).abs().max().item<double>() < 1e-5);
  CHECK(found.left.max().item<double>() < 1e-9);
}

TEST_CASE("linear answer: what is left is the noise, and frames that do not count change nothing") {
  Convolved data = convolved(5000);
  data.target += torch::randn({5000, 2}) * torch::tensor({0.1, 0.5});
  auto counts = torch::ones({5000}, torch::kBool);
  counts.slice(0, 0, 1000) = false;
  data.target.slice(0, 0, 1000) = 1e6;
  LinearFit fit(6, 2, 5);
  fit.add(data.input, data.target, counts);
  const LinearAnswer found = fit.solved(1.0);
  CHECK((found.weight - data.weight).abs().max().item<double>() < 0.05);
  CHECK(found.left[0].item<double>() == doctest::Approx(0.01).epsilon(0.1));
  CHECK(found.left[1].item<double>() == doctest::Approx(0.25).epsilon(0.1));
}

TEST_CASE("linear answer: a penalty draws weights to 0, and without rows all is 0") {
  const Convolved data = convolved(100);
  LinearFit fit(6, 2, 5);
  CHECK(fit.solved(1.0).weight.abs().max().item<double>() == 0.0);
  fit.add(data.input, data.target, torch::ones({100}, torch::kBool));
  CHECK(fit.solved(100.0).weight.norm().item<double>() <
        0.7 * fit.solved(1e-6).weight.norm().item<double>());
}
