// SPDX-License-Identifier: Apache-2.0
// BRA-P's second network: an autoencoder of clean motion. During training its features judge the
// answer of the first network. At use it refines the first network's answer.
#pragma once

#include "kinalign/learn/trainer.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

namespace kinalign {

/// A network from answers [B,T,3 Jout] m, in the body's frame, to cleaner ones of the same shape.
/// The form of BRA's network, with a narrow layer in the middle, which motion_features() reads.
Architecture clean_motion_architecture(std::size_t answers);

/// Trains the network on the truth of `pairs`, with noise of 1 cm on the joints and random dropout
/// of joints.
Result<TorchNetwork> fit_clean_motion(const DenoiseLayout& layout, const std::vector<Pair>& pairs,
                                      const TrainingOptions& options, torch::Device device,
                                      const TrainingHooks& hooks);

/// The features [B,T,C] of the network's narrow middle layer.
torch::Tensor motion_features(const TorchNetwork& network, const torch::Tensor& answers);

}  // namespace kinalign
