// SPDX-License-Identifier: Apache-2.0
// From pairs and a method to a model.
#pragma once

#include "kinalign/learn/method.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/pairs.h"

namespace kinalign {

struct DenoiseFit {
  DenoiseModel model;  // without facts of its data
  std::vector<TrainingPoint> points;
};

struct FitOptions {
  TrainingOptions training;
  torch::Device device = torch::kCPU;
};

/// What of the pairs is trained on, and what judges the network while it is.
struct DividedPairs {
  std::vector<Pair> learnt, judged;
};

/// `pairs`: the joints and the rate; those in `divided` are used.
/// `from`: a model of that method to go on from; `pairs` are of its joints (pairs_for()).
Result<DenoiseFit> fit_denoise(const DenoiseMethod& method, const Pairs& pairs,
                               const DividedPairs& divided, const FitOptions& options,
                               TrainingState state, const TrainingHooks& hooks,
                               const DenoiseModel* from = nullptr);

/// Lets the method's network begin as the method says.
void begin_network(const DenoiseMethod& method, const DenoiseTask& task, TorchNetwork& network);

/// The network's weights as a model's file holds them, `prefix` before each name.
void put_tensors(const TorchNetwork& network, const std::string& prefix,
                 std::map<std::string, Tensor>& out);
/// The way back. Fails where a tensor is missing or has another shape.
Result<void> take_tensors(const std::map<std::string, Tensor>& tensors, const std::string& prefix,
                          TorchNetwork& network);

}  // namespace kinalign
