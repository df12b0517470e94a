// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/trainer.h"

#include "kinalign/simulate/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinalign {

namespace {

using WeightMap = std::map<std::string, torch::Tensor>;

/// Adam's decay of the first and the second moment.
constexpr double first_decay = 0.9, second_decay = 0.98, epsilon = 1e-8;
// The moving average of the weights uses a smaller decay at first, so that it follows quickly.
constexpr double average_decay = 0.999;
// A single step that is not finite is skipped; several in a row mean that training has failed.
constexpr int most_failures = 5;
// A point of the log is written at multiples of this number of steps. Checkpoints usually follow a
// point, so that no sum is incomplete when a state is stored.
constexpr std::int64_t point_every = 50;

/// Moves from `from` to `to` along half a cosine; `share` goes from 0 to 1.
double eased(double from, double to, double share) {
  return to + (from - to) * 0.5 * (1.0 + std::cos(std::numbers::pi * share));
}

WeightMap copy_of(const WeightMap& tensors) {
  WeightMap out;
  for (const auto& [name, tensor] : tensors) out[name] = tensor.detach().clone();
  return out;
}

WeightMap zeros_like(const WeightMap& tensors) {
  WeightMap out;
  for (const auto& [name, tensor] : tensors) out[name] = torch::zeros_like(tensor).detach();
  return out;
}

void put_weights(const WeightMap& from, TorchNetwork& network) {
  torch::NoGradGuard guard;
  for (auto& [name, tensor] : network.tensors()) tensor.copy_(from.at(name));
}

/// Initialises the state of a new run, or moves that of a checkpoint to the network's device.
void begin(const TorchNetwork& network, TrainingState& state) {
  if (!state.weights.empty()) {
    for (WeightMap* one :
         {&state.weights, &state.first, &state.second, &state.average, &state.best}) {
      for (auto& [name, tensor] : *one) tensor = tensor.to(network.tensors().at(name).device());
    }
    return;
  }
  state.weights = copy_of(network.tensors());
  state.first = zeros_like(network.tensors());
  state.second = zeros_like(network.tensors());
  state.average = copy_of(network.tensors());
}

/// The norm of all gradients together. It is summed in double, tensor by tensor in the order of
/// names, so that the result is repeatable.
double gradient_norm(const WeightMap& tensors) {
  double sum = 0.0;
  for (const auto& [name, tensor] : tensors) {
    if (tensor.grad().defined()) sum += tensor.grad().pow(2).sum().item<double>();
  }
  return std::sqrt(sum);
}

/// One step of AdamW (Loshchilov and Hutter, 2019).
void step_weights(TorchNetwork& network, const TrainingOptions& options, double norm,
                  TrainingState& state) {
  torch::NoGradGuard guard;
  const double rate = rate_at(options, state.step), n = static_cast<double>(state.step + 1);
  const double cut = norm > options.longest_gradient ? options.longest_gradient / norm : 1.0;
  // Adam's corrections of both moments, which start at 0, in one factor.
  const double correction =
      std::sqrt(1.0 - std::pow(second_decay, n)) / (1.0 - std::pow(first_decay, n));
  const double kept = std::min(average_decay, (1.0 + n) / (10.0 + n));
  for (auto& [name, weight] : network.tensors()) {
    if (!weight.grad().defined()) continue;
    const torch::Tensor gradient = weight.grad() * cut;
    torch::Tensor& first = state.first.at(name);
    torch::Tensor& second = state.second.at(name);
    first.mul_(first_decay).add_(gradient, 1.0 - first_decay);
    second.mul_(second_decay).addcmul_(gradient, gradient, 1.0 - second_decay);
    // Weight decay acts before the step and not through the gradient (AdamW), and only on matrices.
    if (weight.dim() > 1) weight.mul_(1.0 - rate * options.weight_decay);
    weight.addcdiv_(first, second.sqrt().add_(epsilon), -rate * correction);
    state.average.at(name).mul_(kept).add_(weight, 1.0 - kept);
  }
}

/// Measures the validation error with the weights that would be kept, and stores the best weights.
std::optional<double> judge(TorchNetwork& network, TrainingTask& task,
                            const TrainingOptions& options, TrainingState& state) {
  // Training goes on from the weights without the average, so they are restored afterwards.
  const WeightMap now = copy_of(network.tensors());
  if (options.average) put_weights(state.average, network);
  // The first process decides for all, so that all processes stop at the same step.
  const BatchShare& share = task.share();
  const auto judgement = share.of_first(share.is_first() ? task.judge(network) : std::nullopt);
  if (!judgement || !state.best_judgement || *judgement < *state.best_judgement) {
    state.best = copy_of(network.tensors());
    state.best_judgement = judgement;
    state.without_better = 0;
  } else {
    ++state.without_better;
  }
  put_weights(now, network);
  return judgement;
}

/// Sums since the last point of the log.
struct Sums {
  double loss = 0.0, gradient = 0.0;
  std::int64_t count = 0;
};

void add_point(const TrainingOptions& options, std::optional<double> judgement, Sums& sums,
               TrainingState& state) {
  const double n = static_cast<double>(std::max<std::int64_t>(sums.count, 1));
  state.points.push_back({state.step, sums.loss / n,
                          rate_at(options, std::max<std::int64_t>(state.step - 1, 0)),
                          sums.gradient / n, judgement});
  sums = {};
}

/// Adds the losses and gradients of all processes' parts. Returns the total loss.
double joined(double loss, WeightMap& tensors, const BatchShare& share) {
  if (share.is_alone()) return loss;
  std::vector<torch::Tensor> pieces{torch::tensor({loss}, torch::kFloat32)};
  for (auto& [name, tensor] : tensors) {
    if (tensor.grad().defined()) pieces.push_back(tensor.grad().flatten().to(torch::kCPU));
  }
  // Loss and gradients are sent in one tensor, so each step needs one message between processes.
  const torch::Tensor all = share.total(torch::cat(pieces));
  std::int64_t at = 1;
  for (auto& [name, tensor] : tensors) {
    if (!tensor.grad().defined()) continue;
    const std::int64_t count = tensor.numel();
    tensor.mutable_grad().copy_(all.slice(0, at, at + count).reshape(tensor.sizes()));
    at += count;
  }
  return all[0].item<double>();
}

/// Computes loss and gradients of the next batch. Returns the gradient's norm; empty if a number is
/// not finite.
std::optional<double> gradients(TorchNetwork& network, TrainingTask& task,
                                const TrainingOptions& options, const TrainingState& state,
                                Sums& sums) {
  for (auto& [name, tensor] : network.tensors()) {
    if (tensor.grad().defined()) tensor.mutable_grad().reset();
  }
  const auto step = static_cast<std::uint64_t>(state.step);
  // The seed of each step is a function of its number, so a continued run draws the same dropout.
  torch::manual_seed(mix64(mix64(options.seed) ^ step));  // for dropout
  const torch::Tensor loss = task.loss(network, options.seed, step);
  loss.backward();
  const double value = joined(loss.item<double>(), network.tensors(), task.share());
  const double norm = gradient_norm(network.tensors());
  if (!std::isfinite(value) || !std::isfinite(norm)) return std::nullopt;
  sums.loss += value;
  sums.gradient += norm;
  ++sums.count;
  return norm;
}

Failure lost_process() {
  return Failure(Error{"", 0, "all processes of the training to run to the end",
                       "a process that ended early (its own message says why)",
                       ErrorKind::lost_process});
}

bool is_due(std::int64_t step, std::int64_t every) { return every > 0 && step % every == 0; }

}  // namespace

double rate_at(const TrainingOptions& options, std::int64_t step) {
  const double steps = static_cast<double>(options.steps), at = static_cast<double>(step);
  const double peak = std::max(1.0, options.rise * steps - 1.0), end = steps - 1.0;
  const double first = options.rate / 25.0;
  if (at < peak) return eased(first, options.rate, at / peak);
  return eased(options.rate, first / 1e4, std::min(1.0, (at - peak) / std::max(1.0, end - peak)));
}

// Each turn computes gradients, makes a step, validates if due, writes a point of the log and
// stores a checkpoint. The checkpoint comes last, so that it contains the validation error and the
// point.
Result<TrainingState> train(TorchNetwork& network, TrainingTask& task,
                            const TrainingOptions& options, TrainingState state,
                            const TrainingHooks& hooks) {
  task.share_with(hooks.share);
  begin(network, state);
  put_weights(state.weights, network);
  Sums sums;
  int failures = 0;
  while (state.step < options.steps) {
    const auto norm = gradients(network, task, options, state, sums);
    if (task.share().is_broken()) return lost_process();
    failures = norm ? 0 : failures + 1;
    if (failures == most_failures) {
      return Failure(Error{"", 0, "a finite loss",
                           "NaN or infinity at steps up to " + std::to_string(state.step)});
    }
    if (norm) step_weights(network, options, *norm, state);
    ++state.step;
    const bool last = state.step == options.steps;
    std::optional<double> judgement;
    if (last || is_due(state.step, options.judge_every)) {
      judgement = judge(network, task, options, state);
      if (task.share().is_broken()) return lost_process();
    }
    if (last || judgement || is_due(state.step, point_every)) {
      add_point(options, judgement, sums, state);
    }
    // Only here `weights` of the state is updated; all other members are always current.
    if (!last && hooks.keep && is_due(state.step, hooks.every)) {
      state.weights = copy_of(network.tensors());
      KA_TRY(hooks.keep(state));
    }
    if (!go_on(hooks.progress, "training", static_cast<std::uint64_t>(state.step),
               static_cast<std::uint64_t>(options.steps))) {
      return Failure(interruption());
    }
    if (options.patience > 0 && state.without_better >= options.patience) break;
  }
  if (state.best.empty()) state.best = copy_of(options.average ? state.average : network.tensors());
  put_weights(state.best, network);
  state.weights = copy_of(network.tensors());
  return state;
}

}  // namespace kinalign
