// SPDX-License-Identifier: Apache-2.0
// The best linear map from stacked frames to a pose, as the weights of a convolution.
#pragma once

#include "kinalign/learn/pose/pose_task.h"

#include <cstdint>
#include <string>

namespace kinalign {

/// Sets the tensors of the convolution at `path` in `network`, which sees the task's inputs and
/// answers alone: ridge regression on batches drawn from `seed`, without gradients.
void set_ridge(const PoseTask& task, std::uint64_t seed, const Layer& conv, const std::string& path,
               TorchNetwork& network);

}  // namespace kinalign
