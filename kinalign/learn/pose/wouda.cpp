// SPDX-License-Identifier: Apache-2.0
// A linear map of eleven stacked frames, after Wouda, Giuberti, Bellusci, Veltink, «Estimation of
// full-body poses using only five inertial sensors», Sensors 16(12), 2016, which also learns from
// stacked orientations. The weights are those of a convolution, found by ridge regression.
#include "kinalign/learn/pose/pose_methods.h"
#include "kinalign/learn/tensors.h"

namespace kinalign {

namespace {

// 150 batches of 32 crops of 64 frames.
constexpr std::uint64_t ridge_batches = 150;
constexpr double ridge_strength = 1e-3;  // the mean square of a channel is about 0.1 to 1

Layer wouda_layer(const PoseLayout& layout) {
  return {.kind = LayerKind::conv, .out = layout.answers(), .kernel = 11};
}

Architecture wouda_architecture(const PoseLayout& layout) {
  return {layout.channels(), {wouda_layer(layout)}};
}

/// Rows [B T, C taps + 1] in the order of the convolution's weights: all taps channel by channel,
/// then a 1.
torch::Tensor stacked(const torch::Tensor& input, const Layer& conv) {
  const std::int64_t reach = whole(conv.kernel) - 1, before = conv.causal ? reach : reach / 2;
  const auto padded = torch::constant_pad_nd(input.transpose(1, 2), {before, reach - before});
  const auto taps = padded.unfold(2, whole(conv.kernel), 1);  // [B,C,T,taps]
  const auto rows = taps.permute({0, 2, 1, 3}).flatten(2).flatten(0, 1).to(torch::kFloat64);
  return torch::cat({rows, torch::ones({rows.size(0), 1}, rows.options())}, 1);
}

/// Sets the weights by ridge regression on batches drawn from `seed`, without gradients.
void begin_wouda(const PoseTask& task, std::uint64_t seed, TorchNetwork& network) {
  const Layer& conv = network.architecture().layers[0];
  torch::NoGradGuard guard;
  // The solution W of (squares + ridge) W = products; both matrices are sums over all frames.
  torch::Tensor squares, products;
  double frames = 0.0;
  for (std::uint64_t step = 0; step < ridge_batches; ++step) {
    const auto batch = task.draw(seed, step);
    const auto rows = stacked(batch.input, conv);
    const auto identity = torch::eye(3, batch.rotations.options()).slice(0, 0, 2);
    // The form of a network's answer: two columns of the rotation, without the identity.
    const auto six = (batch.rotations.slice(3, 0, 2) - identity).flatten(2).flatten(0, 1);
    const auto square = torch::matmul(rows.t(), rows);
    const auto product = torch::matmul(rows.t(), six.to(torch::kFloat64));
    squares = squares.defined() ? squares + square : square;
    products = products.defined() ? products + product : product;
    frames += static_cast<double>(rows.size(0));
  }
  auto ridge = torch::full({squares.size(0)}, ridge_strength * frames, squares.options());
  ridge.slice(0, ridge.size(0) - 1).zero_();  // the constant is not penalised
  const auto weights = torch::linalg_solve(squares + torch::diag(ridge), products).t();
  const std::int64_t taps = weights.size(1) - 1;
  torch::Tensor& kept = network.tensors().at("0.weight");
  kept.copy_(weights.slice(1, 0, taps).reshape(kept.sizes()));
  network.tensors().at("0.bias").copy_(weights.slice(1, taps).squeeze(1));
}

}  // namespace

PoseMethod wouda_method() {
  return {.name = "wouda",
          .summary = "ridge regression over eleven frames",
          .source = "after Wouda et al., Sensors 16(12), 2016",
          .architecture = wouda_architecture,
          .training = {},
          .options = {.steps = 0},
          .begin = begin_wouda};
}

std::vector<PoseMethod> pose_methods() {
  return {inertial_method(), inertial_online_method(), dip_method(),
          dip_512_method(),  dip_robust_method(),      wouda_method()};
}

}  // namespace kinalign
