// SPDX-License-Identifier: Apache-2.0
// Trains a model that cleans skeletons, from pairs and a method.
#pragma once

#include "kinalign/learn/method.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/pairs.h"

namespace kinalign {

struct DenoiseFit {
  DenoiseModel model;  // in `facts` only task and method are set
  std::vector<TrainingPoint> points;
};

/// The choices of the user; all else comes from the method.
struct FitOptions {
  TrainingOptions training;
  torch::Device device = torch::kCPU;
};

/// Pairs to train on (`learnt`), and pairs for validation (`judged`). Both should not contain the
/// same person, because the validation error would then be too small.
struct DividedPairs {
  std::vector<Pair> learnt, judged;
};

/// Trains a model. `pairs` gives only the joints and the rate; the data are those of `divided`.
/// `from`: a model of the same method to continue from; then `pairs` must have its joints
/// (pairs_for()).
Result<DenoiseFit> fit_denoise(const DenoiseMethod& method, const Pairs& pairs,
                               const DividedPairs& divided, const FitOptions& options,
                               TrainingState state, const TrainingHooks& hooks,
                               const DenoiseModel* from = nullptr);

/// Initialises the network as the method demands.
void begin_network(const DenoiseMethod& method, const DenoiseTask& task, TorchNetwork& network);

/// Copies the network's weights to `out`, with `prefix` before each name.
void put_tensors(const TorchNetwork& network, const std::string& prefix,
                 std::map<std::string, Tensor>& out);
/// The inverse of put_tensors(). Fails if a tensor is missing or has another shape.
Result<void> take_tensors(const std::map<std::string, Tensor>& tensors, const std::string& prefix,
                          TorchNetwork& network);

}  // namespace kinalign
