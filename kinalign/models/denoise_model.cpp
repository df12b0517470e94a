// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/denoise_model.h"

#include "kinalign/models/bones.h"
#include "kinalign/models/model_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

Steadier::Steadier(const Steadying& how, const DenoiseLayout& layout)
    : how_(how),
      parents_(layout.parents),
      inputs_(mirror_partners(layout.inputs)),
      outputs_(mirror_partners(layout.outputs)) {}

// The mirror image of a person's motion is a possible motion, too. The mean of the results for both
// cancels errors that prefer one side (mirror averaging). Smoothing comes before the constant
// bones, because smoothing changes bone lengths.
Denoised Steadier::steadied(const Answer& answer, const JointFrames& body, Denoised plain) const {
  std::vector<float>& positions = plain.positions;
  if (how_.mirror) {
    JointFrames other = body;
    mirror(other, inputs_);
    std::vector<float> mirrored = answer(other).positions;
    mirror_positions(mirrored, outputs_);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i] = 0.5F * (positions[i] + mirrored[i]);
    }
  }
  smooth(how_.smoothing, 3 * parents_.size(), positions);
  if (how_.bones) {
    impose_lengths(parents_, typical_lengths(parents_, outputs_, positions), positions);
  }
  return plain;
}

Result<Denoiser> Denoiser::make(DenoiseModel model) {
  // A network that also estimates its error (the spread) has one more channel for each output
  // joint, after the positions.
  const std::size_t answers = model.layout.answers();
  const std::size_t outputs = answers + (model.states_spread ? model.layout.outputs.size() : 0);
  Network network = KA_TRY(Network::make(model.architecture, tensors_below(model.tensors, "net.")));
  const auto fits = [](const Network& one, std::size_t in, std::size_t out) -> Result<void> {
    const auto count = [&](LayerKind kind) {
      const auto& layers = one.architecture().layers;
      return std::count_if(layers.begin(), layers.end(),
                           [&](const Layer& layer) { return layer.kind == kind; });
    };
    // Within branches validate() (infer/shapes.h) has already checked this.
    if (count(LayerKind::max_pool) != count(LayerKind::unpool)) {
      return Failure(
          Error{"", 0, "a network with as many frames out as in", "a max_pool without unpool"});
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
      steadier_(model_.steadying, model_.layout) {}

void Denoiser::standardise(DenoiseFeatures& features) const {
  const std::size_t channels = model_.layout.channels();
  for (std::size_t at = 0; at < features.input.size(); at += channels) {
    for (std::size_t c = 0; c < channels; ++c) {
      float& value = features.input[at + c];
      value = (value - model_.input_mean[c]) / model_.input_scale[c];
    }
  }
}

Denoised Denoiser::answer_of(const DenoiseFeatures& features, std::span<const float> answers,
                             std::size_t first, std::size_t end) const {
  const std::size_t width = model_.layout.answers(), joints = model_.layout.outputs.size();
  const std::size_t row = network_.outputs();
  const auto scale = static_cast<float>(model_.answer_scale);
  const auto base = features.base.begin();
  Denoised out{.positions = {base + static_cast<std::ptrdiff_t>(first * width),
                             base + static_cast<std::ptrdiff_t>(end * width)},
               .spread = {}};
  for (std::size_t t = first; t < end; ++t) {
    for (std::size_t c = 0; c < width; ++c) {
      out.positions[(t - first) * width + c] +=
          model_.answer_mean[c] + scale * answers[t * row + c];
    }
    for (std::size_t j = 0; j < joints && model_.states_spread; ++j) {
      // The network outputs the logarithm of the spread in centimetres, so the spread is always
      // positive.
      const double centimetres = std::exp(static_cast<double>(answers[t * row + width + j]));
      out.spread.push_back(static_cast<float>(centimetres * 0.01 * model_.spread_factor));
    }
  }
  return out;
}

// The second network of the method bra-p was trained on motion in the body's frame, so it runs
// before to_world().
void Denoiser::apply_second(Denoised& answer) {
  if (!second_) return;
  std::vector<float> out;
  second_->run(answer.positions, answer.positions.size() / second_->inputs(), workspace_, out);
  answer.positions = std::move(out);
}

Denoised Denoiser::answer(const JointFrames& body) {
  DenoiseFeatures features = denoise_features(model_.layout, body);
  standardise(features);
  const std::size_t frames = body.frames();
  std::vector<float> out;
  network_.run(features.input, frames, workspace_, out);
  Denoised answer = answer_of(features, out, 0, frames);
  apply_second(answer);
  to_world(features.frames, answer.positions);
  return answer;
}

// If the model averages with the mirror image, the network runs twice: for the body and for the
// image.
Denoised Denoiser::clean(const JointFrames& body) {
  const auto again = [this](const JointFrames& other) { return answer(other); };
  return steadier_.steadied(again, body, answer(body));
}

}  // namespace kinalign
