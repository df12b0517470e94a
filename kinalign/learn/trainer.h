// SPDX-License-Identifier: Apache-2.0
// The loop that trains a network for a task: AdamW, a learning rate that rises and falls, clipped
// gradients, a moving average of the weights, early stopping. All random numbers are functions of
// the seed and the step's number, so that an interrupted run continues with the same result.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/progress.h"
#include "kinalign/learn/batch_share.h"
#include "kinalign/learn/torch_network.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// A training task: batches with their loss, and a validation of the network. train() calls loss()
/// once a step, and judge() in the first process only.
class TrainingTask {
 public:
  TrainingTask() = default;
  TrainingTask(const TrainingTask&) = delete;
  TrainingTask& operator=(const TrainingTask&) = delete;
  virtual ~TrainingTask() = default;
  /// The loss of batch `step`, drawn from `seed`. With several processes: this process's
  /// contribution.
  virtual torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed,
                             std::uint64_t step) = 0;
  /// The validation error; smaller is better. Empty if there is no validation part.
  virtual std::optional<double> judge(const TorchNetwork& network) = 0;

  void share_with(const BatchShare& share) { share_ = share; }
  const BatchShare& share() const { return share_; }

 private:
  BatchShare share_;
};

/// Defaults are the usual choice; each method sets its own values. `kinalign train` may change
/// steps, rate, seed, validation and patience.
struct TrainingOptions {
  std::int64_t steps = 1200;
  double rate = 2e-3;            // the highest learning rate
  double rise = 0.3;             // share of the steps in which the rate rises
  double weight_decay = 1e-2;    // applies to matrices only
  double longest_gradient = 1;   // norm of the gradient; longer gradients are scaled down to it
  bool average = true;           // validate and keep the moving average of the weights
  std::int64_t judge_every = 0;  // steps between validations; 0: only at the end
  std::int64_t patience = 0;     // stop after so many validations without improvement; 0: never
  std::uint64_t seed = 1;
};

/// A line of the log. `judgement` is the validation error, at steps at which it was measured.
struct TrainingPoint {
  std::int64_t step = 0;
  double loss = 0.0;  // mean since the last point
  double rate = 0.0;
  double gradient = 0.0;  // norm before clipping, mean since the last point
  std::optional<double> judgement;
};

/// The state of a run: everything that the next step depends on.
struct TrainingState {
  std::int64_t step = 0;
  std::map<std::string, torch::Tensor> weights, first, second, average, best;
  std::optional<double> best_judgement;
  std::int64_t without_better = 0;
  std::vector<TrainingPoint> points;
};

struct TrainingHooks {
  Progress progress{};
  /// Called every `every` steps to store the state; may be empty.
  std::function<Result<void>(const TrainingState&)> keep{};
  std::int64_t every = 500;
  /// This process's share if several processes train together. All of them need the same options,
  /// data and state.
  BatchShare share{};
};

/// Trains `network`, starting from `state` (empty: from the network's own weights). At the end the
/// network has the best weights. Fails if the loss is not finite in five successive steps, or if
/// another process ends.
Result<TrainingState> train(TorchNetwork& network, TrainingTask& task,
                            const TrainingOptions& options, TrainingState state,
                            const TrainingHooks& hooks);

/// The learning rate of a step: half a cosine from `rate` / 25 up to `rate`, then one down to
/// `rate` / 250,000 (Smith's one cycle, as in PyTorch's OneCycleLR).
double rate_at(const TrainingOptions& options, std::int64_t step);

}  // namespace kinalign
