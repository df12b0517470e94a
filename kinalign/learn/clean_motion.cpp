// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/clean_motion.h"

#include "kinalign/learn/denoise_task.h"
#include "kinalign/learn/losses.h"
#include "kinalign/simulate/random.h"

#include <algorithm>

namespace kinalign {

namespace {

// The article on BRA-P (methods/bra.cpp) gives no sizes. These are our choice: noise of 1 cm, one
// joint in ten dropped.
constexpr std::size_t clean_units = 256, latent_layers = 5;
constexpr std::int64_t batch = 32, crop = 61;
constexpr double noise = 0.01, dropped = 0.1;  // m; share of dropped joints

/// Training task: removes noise from clean motion. The network later gets joints in the body's
/// frame of a Kinect. The clean motion is therefore transformed into the body's frame of the pair's
/// input.
class CleanMotionTask : public TrainingTask {
 public:
  CleanMotionTask(const DenoiseLayout& layout, const std::vector<Pair>& pairs, torch::Device device)
      : device_(device) {
    const auto joints = torch::tensor(weights_of_outputs(layout, 1.0));
    weights_ = (joints / joints.mean()).repeat_interleave(3).to(device);
    for (const Pair& pair : pairs) {
      if (pair.input.frames() < static_cast<std::size_t>(crop)) continue;
      std::vector<float> truth = pair.truth;
      to_body(denoise_features(layout, pair.input).frames, truth);
      motions_.push_back(torch::from_blob(truth.data(),
                                          {static_cast<std::int64_t>(pair.input.frames()),
                                           static_cast<std::int64_t>(layout.answers())},
                                          torch::kFloat32)
                             .clone());
    }
  }

  bool empty() const { return motions_.empty(); }

  /// The loss of one batch of random crops, with fresh noise.
  torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed, std::uint64_t step) override {
    const RandomStream random(seed, step);
    std::vector<torch::Tensor> pieces;
    for (std::int64_t k = 0; k < batch; ++k) {
      const auto below = [&](std::uint64_t lane, std::int64_t n) {
        const double value = random.uniform(static_cast<std::uint64_t>(k), lane);
        return std::min(static_cast<std::int64_t>(value * static_cast<double>(n)), n - 1);
      };
      const auto& motion =
          motions_[static_cast<std::size_t>(below(0, static_cast<std::int64_t>(motions_.size())))];
      const std::int64_t begin = below(1, motion.size(0) - crop + 1);
      pieces.push_back(motion.slice(0, begin, begin + crop));
    }
    const auto clean = torch::stack(pieces).to(device_);
    auto rough = clean + torch::randn_like(clean) * noise;
    const auto kept = torch::rand({batch, 1, clean.size(2) / 3, 1}, clean.options()).gt(dropped);
    rough = (rough.reshape({batch, crop, -1, 3}) * kept).flatten(2);
    // Every process draws the noise of the whole batch, so that all processes have the same noise.
    const BatchPart part = share().part(batch);
    const auto own = [&](const torch::Tensor& x) {
      return x.slice(0, part.begin, part.begin + part.count);
    };
    // The loss in cm: the squared error, plus half the error of accelerations, which makes the
    // motion smooth.
    const auto error = (network.forward(own(rough), part) - own(clean)) * 100.0;
    return part.mean(error.pow(2) * weights_) +
           0.5 * part.mean(second_differences(error).abs() * weights_);
  }

  // There is no validation part, so train() keeps the weights of the last step.
  std::optional<double> judge(const TorchNetwork&) override { return std::nullopt; }

 private:
  torch::Device device_;
  std::vector<torch::Tensor> motions_;  // [T,3 Jout] m, in the body's frame
  torch::Tensor weights_;               // [3 Jout], mean 1
};

}  // namespace

Architecture clean_motion_architecture(std::size_t answers) {
  const Layer recurrent{.kind = LayerKind::lstm, .out = clean_units, .bidirectional = true};
  return {answers,
          {{.kind = LayerKind::linear, .out = clean_units},
           {.kind = LayerKind::tanh},
           {.kind = LayerKind::dropout, .rate = 0.2},
           recurrent,
           {.kind = LayerKind::linear, .out = clean_units},
           {.kind = LayerKind::dropout, .rate = 0.2},
           recurrent,
           {.kind = LayerKind::linear, .out = answers}}};
}

Result<TorchNetwork> fit_clean_motion(const DenoiseLayout& layout, const std::vector<Pair>& pairs,
                                      const TrainingOptions& options, torch::Device device,
                                      const TrainingHooks& hooks) {
  CleanMotionTask task(layout, pairs, device);
  if (task.empty()) {
    return Failure(Error{"", 0, "stretches of 61 rows of clean motion", "none"});
  }
  torch::manual_seed(options.seed + 1);
  TorchNetwork network(clean_motion_architecture(layout.answers()));
  network.to(device);
  // The seed differs from that of the first network, so that both do not draw the same crops.
  TrainingOptions own = options;
  own.seed = options.seed + 1;
  own.judge_every = 0;
  own.patience = 0;
  // This part stores no checkpoints, because checkpoints belong to the first network, which is
  // trained afterwards. An interrupted run starts this part again.
  if (auto done = train(network, task, own, {}, {.progress = hooks.progress, .share = hooks.share});
      !done) {
    return Failure(done.error());
  }
  return network;
}

torch::Tensor motion_features(const TorchNetwork& network, const torch::Tensor& answers) {
  Architecture encoder = network.architecture();
  encoder.layers.resize(latent_layers);
  // The features are normalised for each frame, so that the loss does not depend on their scale.
  const auto features = run_layers(encoder.layers, network.tensors(), answers);
  return torch::layer_norm(features, {features.size(2)});
}

}  // namespace kinalign
