// SPDX-License-Identifier: Apache-2.0
// A network with the layers of `infer`, with gradients. Tensors have the names stated in
// infer/architecture.h.
#pragma once

#include "kinalign/infer/architecture.h"
#include "kinalign/learn/batch_share.h"

#include <torch/torch.h>

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Its outputs agree with those of infer's Network up to rounding, so a model that was trained here
/// runs without LibTorch. Tensors have the names that a model's file has.
class TorchNetwork {
 public:
  /// Draws the weights from torch's generator, which must be seeded before: uniform within
  /// 1/sqrt(fan in) as in PyTorch's modules, recurrent matrices orthogonal, the forget gate's bias
  /// 1.
  explicit TorchNetwork(Architecture architecture);

  /// Maps [B,T,inputs] to [B,T,outputs]. `training`: with dropout.
  torch::Tensor forward(const torch::Tensor& input, bool training) const;
  /// In training, for a part of a batch. The random dropout is that of the whole batch.
  torch::Tensor forward(const torch::Tensor& input, const BatchPart& part) const;

  /// Sets the weights of the last linear or conv layer to 0, so that the network outputs `bias`
  /// [outputs], or 0 if `bias` is undefined. A network that outputs corrections then begins without
  /// a correction.
  void zero_last(const torch::Tensor& bias = {});
  void to(torch::Device device);

  const Architecture& architecture() const { return architecture_; }
  std::map<std::string, torch::Tensor>& tensors() { return tensors_; }
  const std::map<std::string, torch::Tensor>& tensors() const { return tensors_; }

 private:
  Architecture architecture_;
  std::map<std::string, torch::Tensor> tensors_;
};

/// Runs `layers` with the tensors of a network, without dropout; returns the output.
torch::Tensor run_layers(const std::vector<Layer>& layers,
                         const std::map<std::string, torch::Tensor>& tensors,
                         const torch::Tensor& input);

}  // namespace kinalign
