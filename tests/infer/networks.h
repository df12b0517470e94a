// SPDX-License-Identifier: Apache-2.0
// Layers, tensors and sequences for tests.
#pragma once

#include "kinalign/infer/network.h"
#include "kinalign/infer/shapes.h"

#include <doctest/doctest.h>

#include <random>

namespace kinalign {

using enum LayerKind;

using Tensors = std::map<std::string, Tensor>;

inline Layer centred_conv(std::size_t out, std::size_t kernel, std::size_t dilation) {
  return {.kind = LayerKind::conv, .out = out, .kernel = kernel, .dilation = dilation};
}

inline Layer causal_conv(std::size_t out, std::size_t kernel, std::size_t dilation) {
  Layer layer = centred_conv(out, kernel, dilation);
  layer.causal = true;
  return layer;
}

inline Layer layer(LayerKind kind, std::size_t out = 0) { return {.kind = kind, .out = out}; }

inline Layer branches(LayerKind kind, std::vector<std::vector<Layer>> branches) {
  return {.kind = kind, .branches = std::move(branches)};
}

inline std::vector<float> random_values(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal(0.0F, 0.5F);
  std::vector<float> out(n);
  for (float& value : out) value = normal(random);
  return out;
}

inline Tensors random_tensors(const Architecture& architecture, std::uint64_t seed) {
  Tensors out;
  for (const Parameter& parameter : parameters(architecture)) {
    std::size_t n = 1;
    for (const std::size_t size : parameter.shape) n *= size;
    out[parameter.name] = {parameter.shape, random_values(n, ++seed)};
  }
  return out;
}

/// A network with every kind of layer that can run frame by frame.
inline Architecture online_architecture() {
  const Layer leaky{.kind = leaky_relu, .slope = 0.125};
  const Layer tail{.kind = slice, .out = 5, .begin = 2};
  const Layer block = branches(
      sum, {{}, {layer(layer_norm), causal_conv(24, 3, 4), layer(gelu), causal_conv(24, 1, 1)}});
  const Layer gate =
      branches(product, {{layer(lstm, 7), layer(tanh)}, {layer(linear, 7), layer(sigmoid)}});
  return {6,
          {layer(linear, 24),
           block,
           leaky,
           {.kind = dropout, .rate = 0.5},
           branches(concat, {{gate}, {layer(gru, 9), tail}, {layer(relu)}}),
           causal_conv(3, 2, 7)}};
}

/// A layer that smooths each channel by itself.
inline Layer smoother(std::size_t window) {
  const Layer block = branches(sum, {{}, {layer(linear, 3), layer(tanh), layer(linear, 12)}});
  return {.kind = along_time,
          .window = window,
          .branches = {{layer(linear, 12), block, layer(linear, window)}}};
}

/// A network with every kind of layer.
inline Architecture offline_architecture() {
  Architecture out = online_architecture();
  Layer both = layer(lstm, 4);
  both.bidirectional = true;
  Layer gates = layer(gru, 5);
  gates.bidirectional = true;
  out.layers.insert(out.layers.begin(),
                    {centred_conv(8, 5, 2), layer(max_pool), both, layer(max_pool), gates,
                     layer(unpool), centred_conv(6, 3, 1), layer(unpool), smoother(9)});
  return out;
}

inline Network network_of(const Architecture& architecture, const Tensors& tensors,
                          const Kernels& kernels = best_kernels()) {
  auto network = Network::make(architecture, tensors, "", kernels);
  REQUIRE(network);
  return *std::move(network);
}

inline std::vector<float> result_of(const Network& network, const std::vector<float>& in) {
  Workspace workspace;
  std::vector<float> out;
  network.run(in, in.size() / network.inputs(), workspace, out);
  return out;
}

}  // namespace kinalign
