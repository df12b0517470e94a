// SPDX-License-Identifier: Apache-2.0
// The second network of BRA-P (methods/bra.cpp): an autoencoder of clean motion. During training
// its features are a part of the first network's loss. In use it refines the first network's
// output.
#pragma once

#include "kinalign/learn/trainer.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

namespace kinalign {

/// A network from joints [B,T,3 Jout] m, in the body's frame, to cleaner joints of the same shape.
/// It has the form of BRA's network, with a narrow layer in the middle, which motion_features()
/// reads.
Architecture clean_motion_architecture(std::size_t answers);

/// Trains the network on the truth of `pairs`, with noise of 1 cm on the joints and random dropout
/// of joints.
Result<TorchNetwork> fit_clean_motion(const DenoiseLayout& layout, const std::vector<Pair>& pairs,
                                      const TrainingOptions& options, torch::Device device,
                                      const TrainingHooks& hooks);

/// The features [B,T,C] in the network's narrow middle layer, for joints as in that function.
torch::Tensor motion_features(const TorchNetwork& network, const torch::Tensor& answers);

}  // namespace kinalign
