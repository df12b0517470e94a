// SPDX-License-Identifier: Apache-2.0
// A model of five joints with one linear layer.
#pragma once

#include "tests/infer/networks.h"
#include "tests/models/bodies.h"

#include "kinalign/models/denoise_model.h"

#include <doctest/doctest.h>

namespace kinalign {

inline std::vector<std::string> leg_names() {
  return {"SpineBase", "HipLeft", "HipRight", "KneeLeft", "KneeRight"};
}

/// A model whose weights are drawn from `seed`; with seed 0 all are 0.
inline DenoiseModel small_model(std::uint64_t seed) {
  DenoiseModel out;
  out.facts = {"denoise", "refine", "0.1.0", R"({"data":[{"name":"walks","licence":"CC0"}]})",
               R"({"mpjpe_cm":3.5})"};
  out.layout = *denoise_layout(leg_names(), leg_names(), 30.0);
  out.states_spread = true;
  out.input_mean.assign(35, 0.25F);
  out.input_scale.assign(35, 0.5F);
  out.answer_mean.assign(15, 0.0F);
  out.architecture = {35, {layer(LayerKind::linear, 20)}};
  for (auto& [name, tensor] : random_tensors(out.architecture, seed)) {
    if (seed == 0) std::fill(tensor.values.begin(), tensor.values.end(), 0.0F);
    out.tensors["net." + name] = tensor;
  }
  return out;
}

/// The legs of moving_body().
inline JointFrames moving_legs(std::size_t frames, std::uint64_t seed) {
  const JointFrames body = moving_body(frames, seed);
  JointFrames out{5, {}, std::vector<std::uint8_t>(frames * 5, 2)};
  for (std::size_t t = 0; t < frames; ++t) {
    for (const std::size_t j : {0U, 12U, 16U, 13U, 17U}) {
      const float* at = &body.positions[(t * body.joints + j) * 3];
      out.positions.insert(out.positions.end(), at, at + 3);
    }
  }
  return out;
}

inline Denoiser denoiser_of(DenoiseModel model) {
  auto out = Denoiser::make(std::move(model));
  REQUIRE(out);
  return *std::move(out);
}

}  // namespace kinalign
