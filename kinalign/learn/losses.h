// SPDX-License-Identifier: Apache-2.0
// Parts of losses that several tasks use.
#pragma once

#include "kinalign/learn/batch_share.h"

#include <torch/torch.h>

namespace kinalign {

/// Lengths of vectors [...,3]. The constant keeps the gradient of the square root finite at 0. For
/// vectors in cm it stands for 0.1 mm.
inline torch::Tensor lengths_of(const torch::Tensor& vectors) {
  return (vectors.pow(2).sum(-1) + 1e-4).sqrt();
}

/// The weighted mean of `values`; 0 if all weights are 0. For a part of a batch: the part's
/// contribution to the mean over the batch. The weights are summed over all processes and the
/// values are not, so that the gradients of the parts add up.
inline torch::Tensor weighted_mean(const torch::Tensor& values, const torch::Tensor& weights,
                                   const BatchShare& share = {}) {
  return (values * weights).sum() / share.total(weights.sum()).clamp_min(1e-6);
}

/// Second differences along T of [B,T,...].
inline torch::Tensor second_differences(const torch::Tensor& x) {
  const auto n = x.size(1);
  return x.slice(1, 2, n) - 2 * x.slice(1, 1, n - 1) + x.slice(1, 0, n - 2);
}

}  // namespace kinalign
