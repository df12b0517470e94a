// SPDX-License-Identifier: Apache-2.0
// A network of the same layers as `infer` runs, with gradients. Tensors have the names that
// infer/architecture.h states.
#pragma once

#include "kinalign/infer/architecture.h"
#include "kinalign/learn/batch_share.h"

#include <torch/torch.h>

#include <map>
#include <string>
#include <vector>

namespace kinalign {

class TorchNetwork {
 public:
  /// Weights drawn from torch's generator (seed it before): uniform within 1/sqrt(fan in), as
  /// PyTorch's modules have them; recurrent matrices orthogonal, the forget gate's bias 1.
  explicit TorchNetwork(Architecture architecture);

  /// [B,T,inputs] to [B,T,outputs]. `training`: with dropout.
  torch::Tensor forward(const torch::Tensor& input, bool training) const;
  /// In training, of a part of a batch: what is dropped is that of the whole batch.
  torch::Tensor forward(const torch::Tensor& input, const BatchPart& part) const;

  /// Weights of the last linear or conv layer become 0, so that it answers with `bias` [outputs],
  /// or 0.
  void zero_last(const torch::Tensor& bias = {});
  void to(torch::Device device);

  const Architecture& architecture() const { return architecture_; }
  std::map<std::string, torch::Tensor>& tensors() { return tensors_; }
  const std::map<std::string, torch::Tensor>& tensors() const { return tensors_; }

 private:
  Architecture architecture_;
  std::map<std::string, torch::Tensor> tensors_;
};

/// The values behind `layers`, of a network's tensors, without dropout.
torch::Tensor run_layers(const std::vector<Layer>& layers,
                         const std::map<std::string, torch::Tensor>& tensors,
                         const torch::Tensor& input);

}  // namespace kinalign
