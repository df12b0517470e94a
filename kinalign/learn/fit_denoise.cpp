// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fit_denoise.h"

#include "kinalign/compare/linear.h"
#include "kinalign/learn/clean_motion.h"
#include "kinalign/learn/tensors.h"

#include <optional>
#include <utility>

namespace kinalign {

namespace {

/// The parts of the model that the task knows before the network is trained.
DenoiseModel begun_model(const DenoiseMethod& method, const DenoiseLayout& layout,
                         const DenoiseTask& task) {
  DenoiseModel out;
  out.facts.task = "denoise";
  out.facts.method = method.name;
  out.layout = layout;
  out.answer_scale = method.training.answer_scale;
  out.states_spread = method.training.states_spread;
  out.input_mean = task.scales().input_mean;
  out.input_scale = task.scales().input_scale;
  out.answer_mean = task.scales().answer_mean;
  return out;
}

}  // namespace

// The network outputs corrections of its base. If they begin at 0, it starts as good as its base.
void begin_network(const DenoiseMethod& method, const DenoiseTask& task, TorchNetwork& network) {
  if (method.begins == Begins::as_base) network.zero_last(task.first_answer());
  if (method.begins != Begins::linear) return;
  network.zero_last();
  const LinearAnswer linear = task.linear_answer();
  torch::NoGradGuard guard;
  // Layer 1 of branch 0 of layer 0: the convolution of refine-linear (methods/refine.cpp).
  network.tensors().at("0.0.1.weight").copy_(linear.weight);
  network.tensors().at("0.0.1.bias").copy_(linear.bias);
}

void put_tensors(const TorchNetwork& network, const std::string& prefix,
                 std::map<std::string, Tensor>& out) {
  for (const auto& [name, tensor] : network.tensors()) {
    out[prefix + name] = from_torch(tensor);
  }
}

Result<void> take_tensors(const std::map<std::string, Tensor>& tensors, const std::string& prefix,
                          TorchNetwork& network) {
  torch::NoGradGuard guard;
  for (auto& [name, tensor] : network.tensors()) {
    const auto found = tensors.find(prefix + name);
    const bool fits =
        found != tensors.end() && to_torch(found->second).sizes().vec() == tensor.sizes().vec();
    if (!fits) {
      return Failure(
          Error{"", 0, "a model of this method's network", "another network at " + name});
    }
    tensor.copy_(to_torch(found->second));
  }
  return {};
}

Result<DenoiseFit> fit_denoise(const DenoiseMethod& method, const Pairs& pairs,
                               const DividedPairs& divided, const FitOptions& options,
                               TrainingState state, const TrainingHooks& hooks,
                               const DenoiseModel* from) {
  if (divided.learnt.empty()) {
    return Failure(Error{"", 0, "pairs to train on", "none"});
  }
  DenoiseLayout layout =
      KA_TRY(denoise_layout(pairs.inputs, pairs.outputs, pairs.rate_hz, pairs.parents));
  if (!method.from_base) layout.bases.assign(layout.outputs.size(), -1);
  // Training that goes on from a model keeps its layout and scales, because its weights were learnt
  // with them.
  if (from != nullptr) layout = from->layout;
  DenoiseTask task(layout, method.training, divided.learnt, divided.judged, options.device);
  if (from != nullptr) task.use_scales({from->input_mean, from->input_scale, from->answer_mean});
  DenoiseFit out{begun_model(method, layout, task), {}};
  std::optional<TorchNetwork> clean;
  if (method.perceptual) {
    clean =
        KA_TRY(fit_clean_motion(layout, divided.learnt, options.training, options.device, hooks));
    // The second network is fixed; otherwise training could lower the loss by changing its
    // features.
    for (auto& [name, tensor] : clean->tensors()) tensor.set_requires_grad(false);
    task.compare_features(
        [&](const torch::Tensor& answers) { return motion_features(*clean, answers); });
    if (method.has_second) {
      out.model.second = clean->architecture();
      put_tensors(*clean, "second.", out.model.tensors);
    }
  }
  // The generator is seeded here and not earlier, because fit_clean_motion() draws from it, too.
  torch::manual_seed(options.training.seed);
  TorchNetwork network(method.architecture(layout));
  if (from == nullptr) begin_network(method, task, network);
  if (from != nullptr) KA_TRY(take_tensors(from->tensors, "net.", network));
  network.to(options.device);
  out.points = KA_TRY(train(network, task, options.training, std::move(state), hooks)).points;
  if (method.training.states_spread) {
    // On people that it was trained on, the network's spread is too small. The ratio of the ridge
    // regression's errors on unseen and on known people corrects this.
    out.model.spread_factor = task.spread_factor(network) * unseen_ratio(layout, divided.learnt);
  }
  out.model.architecture = network.architecture();
  put_tensors(network, "net.", out.model.tensors);
  return out;
}

}  // namespace kinalign
