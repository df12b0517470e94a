// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/denoise_model.h"

#include "kinalign/models/bones.h"
#include "kinalign/models/model_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

void mirror_answer(Denoised& answer, const std::vector<std::size_t>& partners) {
  const std::size_t joints = partners.size();
  JointFrames body{joints, std::move(answer.positions), {}};
  body.seen.assign(body.positions.size() / 3, 2);
  mirror(body, partners);
  answer.positions = std::move(body.positions);
  for (std::size_t at = 0; at + joints <= answer.spread.size(); at += joints) {
    for (std::size_t j = 0; j < joints; ++j) {
      if (partners[j] > j) std::swap(answer.spread[at + j], answer.spread[at + partners[j]]);
    }
  }
}

void steady(const Steadying& how, const std::vector<int>& parents,
            const std::vector<std::size_t>& partners, std::vector<float>& positions) {
  smooth(how.smoothing, 3 * parents.size(), positions);
  if (how.bones) impose_lengths(parents, typical_lengths(parents, partners, positions), positions);
}

Result<Denoiser> Denoiser::make(DenoiseModel model) {
  const std::size_t answers = model.layout.answers();
  const std::size_t outputs = answers + (model.states_spread ? model.layout.outputs.size() : 0);
  Network network = KA_TRY(Network::make(model.architecture, tensors_below(model.tensors, "net.")));
  const auto fits = [](const Network& one, std::size_t in, std::size_t out) -> Result<void> {
    const auto count = [&](LayerKind kind) {
      const auto& layers = one.architecture().layers;
      return std::count_if(layers.begin(), layers.end(),
                           [&](const Layer& layer) { return layer.kind == kind; });
    };
    // Branches keep the number of frames by themselves (validate() of infer/shapes.h).
    if (count(LayerKind::max_pool) != count(LayerKind::unpool)) {
      return Failure(Error{"", 0, "a network with as many frames out as in", "a max_pool alone"});
    }
    if (one.inputs() == in && one.outputs() == out) return {};
    return Failure(Error{"", 0,
                         std::to_string(in) + " channels in and " + std::to_string(out) + " out",
                         std::to_string(one.inputs()) + " and " + std::to_string(one.outputs())});
  };
  KA_TRY(fits(network, model.layout.channels(), outputs));
  std::optional<Network> second;
  if (model.second) {
    second = KA_TRY(Network::make(*model.second, tensors_below(model.tensors, "second.")));
    KA_TRY(fits(*second, answers, answers));
  }
  return Denoiser(std::move(model), std::move(network), std::move(second));
}

Denoiser::Denoiser(DenoiseModel model, Network network, std::optional<Network> second)
    : model_(std::move(model)),
      network_(std::move(network)),
      second_(std::move(second)),
      input_partners_(mirror_partners(model_.layout.inputs)),
      output_partners_(mirror_partners(model_.layout.outputs)) {}

Denoised Denoiser::answer_once(const JointFrames& body) {
  DenoiseFeatures features = denoise_features(model_.layout, body);
  const std::size_t frames = body.frames(), channels = model_.layout.channels();
  const std::size_t answers = model_.layout.answers(), joints = model_.layout.outputs.size();
  for (std::size_t i = 0; i < features.input.size(); ++i) {
    const std::size_t c = i % channels;
    features.input[i] = (features.input[i] - model_.input_mean[c]) / model_.input_scale[c];
  }
  std::vector<float> out;
  network_.run(features.input, frames, workspace_, out);
  Denoised answer{.positions = std::move(features.base), .spread = {}};
  const std::size_t row = network_.outputs();
  const auto scale = static_cast<float>(model_.answer_scale);
  for (std::size_t t = 0; t < frames; ++t) {
    for (std::size_t c = 0; c < answers; ++c) {
      answer.positions[t * answers + c] += model_.answer_mean[c] + scale * out[t * row + c];
    }
    for (std::size_t j = 0; j < joints && model_.states_spread; ++j) {
      const double centimetres = std::exp(static_cast<double>(out[t * row + answers + j]));
      answer.spread.push_back(static_cast<float>(centimetres * 0.01 * model_.spread_factor));
    }
  }
  if (second_) {
    second_->run(answer.positions, frames, workspace_, out);
    answer.positions = out;
  }
  to_world(features.frames, answer.positions);
  return answer;
}

Denoised Denoiser::answer(const JointFrames& body) { return answer_once(body); }

Denoised Denoiser::clean(const JointFrames& body) {
  Denoised out = answer_once(body);
  if (model_.steadying.mirror) {
    JointFrames other = body;
    mirror(other, input_partners_);
    Denoised mirrored = answer_once(other);
    mirror_answer(mirrored, output_partners_);
    for (std::size_t i = 0; i < out.positions.size(); ++i) {
      out.positions[i] = 0.5F * (out.positions[i] + mirrored.positions[i]);
    }
  }
  steady(model_.steadying, model_.layout.parents, output_partners_, out.positions);
  return out;
}

}  // namespace kinalign
