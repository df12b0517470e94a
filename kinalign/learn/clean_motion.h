// SPDX-License-Identifier: Apache-2.0
// BRA-P's second network: an autoencoder of clean motion. Its features judge an answer while the
// first network is trained, and it stands behind the first at use.
#pragma once

#include "kinalign/learn/trainer.h"
#include "kinalign/models/denoise_features.h"
#include "kinalign/models/pairs.h"

namespace kinalign {

/// From answers [B,T,3 Jout] m, in the body's frame, to the same, cleaner.
Architecture clean_motion_architecture(std::size_t answers);

/// Trains it on the truth of `pairs`, whose joints are moved by 1 cm and dropped out at random.
Result<TorchNetwork> fit_clean_motion(const DenoiseLayout& layout, const std::vector<Pair>& pairs,
                                      const TrainingOptions& options, torch::Device device,
                                      const TrainingHooks& hooks);

/// The features [B,T,C] of its narrow middle.
torch::Tensor motion_features(const TorchNetwork& network, const torch::Tensor& answers);

}  // namespace kinalign
