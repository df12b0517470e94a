// SPDX-License-Identifier: Apache-2.0
// The loop that fits a network to a task: AdamW, a learning rate that rises and falls, gradients
// cut at a norm, an average of the weights, early stopping. Everything random is a function of the
// seed and the step's number, so that a run goes on after a kill as if nothing had happened.
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

/// What is learnt: batches with their loss, and a judgement of the network.
class TrainingTask {
 public:
  TrainingTask() = default;
  TrainingTask(const TrainingTask&) = delete;
  TrainingTask& operator=(const TrainingTask&) = delete;
  virtual ~TrainingTask() = default;
  /// The loss of batch `step`, drawn from `seed`; of several processes, this one's share of it.
  virtual torch::Tensor loss(const TorchNetwork& network, std::uint64_t seed,
                             std::uint64_t step) = 0;
  /// Less is better; empty where no validation part was given.
  virtual std::optional<double> judge(const TorchNetwork& network) = 0;

  void share_with(const BatchShare& share) { share_ = share; }
  const BatchShare& share() const { return share_; }

 private:
  BatchShare share_;
};

struct TrainingOptions {
  std::int64_t steps = 1200;
  double rate = 2e-3;            // the highest learning rate
  double rise = 0.3;             // share of the steps in which the rate rises
  double weight_decay = 1e-2;    // of matrices alone
  double longest_gradient = 1;   // norm; longer ones are cut
  bool average = true;           // the weights' moving average is what is judged and kept
  std::int64_t judge_every = 0;  // steps; 0: at the end alone
  std::int64_t patience = 0;     // judgements without a better one, then it stops; 0: never
  std::uint64_t seed = 1;
};

struct TrainingPoint {
  std::int64_t step = 0;
  double loss = 0.0;  // mean since the last point
  double rate = 0.0;
  double gradient = 0.0;  // norm before it is cut
  std::optional<double> judgement;
};

/// Where a run can go on: all that the next step depends on.
struct TrainingState {
  std::int64_t step = 0;
  std::map<std::string, torch::Tensor> weights, first, second, average, best;
  std::optional<double> best_judgement;
  std::int64_t without_better = 0;
  std::vector<TrainingPoint> points;
};

struct TrainingHooks {
  Progress progress{};
  /// Called every `every` steps with the state, to keep it; nothing where empty.
  std::function<Result<void>(const TrainingState&)> keep{};
  std::int64_t every = 500;
  /// This process's part where several train together. All have the same options, data and state.
  BatchShare share{};
};

/// Fits `network` from `state` on (a new one: from the network's own weights). At the end the
/// network has the best weights. Fails where the loss is not finite five times in a row, and where
/// another process ends.
Result<TrainingState> train(TorchNetwork& network, TrainingTask& task,
                            const TrainingOptions& options, TrainingState state,
                            const TrainingHooks& hooks);

/// The learning rate of a step: a cosine up to `rate` and one down to a 10,000th (Smith's one
/// cycle, as PyTorch's OneCycleLR).
double rate_at(const TrainingOptions& options, std::int64_t step);

}  // namespace kinalign
