// SPDX-License-Identifier: Apache-2.0
// From pairs and a method to a model.
#pragma once

#include "kinalign/learn/method.h"
#include "kinalign/learn/pairs.h"
#include "kinalign/models/denoise_model.h"

namespace kinalign {

struct DenoiseFit {
  DenoiseModel model;  // without facts of its data
  std::vector<TrainingPoint> points;
};

struct FitOptions {
  TrainingOptions training;
  torch::Device device = torch::kCPU;
};

Result<DenoiseFit> fit_denoise(const DenoiseMethod& method, const Pairs& pairs,
                               const FitOptions& options, TrainingState state,
                               const TrainingHooks& hooks);

/// The network's weights as a model's file holds them, `prefix` before each name.
void put_tensors(const TorchNetwork& network, const std::string& prefix,
                 std::map<std::string, Tensor>& out);

}  // namespace kinalign
