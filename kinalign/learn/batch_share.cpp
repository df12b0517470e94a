// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/batch_share.h"

namespace kinalign {

// The processes exchange their sums on the CPU. With CUDA, gradients are therefore copied to the
// processor's memory (docs/training_processes.md).
torch::Tensor BatchShare::total(const torch::Tensor& part) const {
  if (is_alone() || broken_) return part.detach();
  torch::Tensor values = part.detach().to(torch::kCPU).clone();
  broken_ = !sum_(values);
  return values.to(part.device());
}

// The value is sent as a sum to which all other processes add zeros, so that one operation between
// processes is enough. A flag says whether there is a value.
std::optional<double> BatchShare::of_first(const std::optional<double>& value) const {
  if (is_alone()) return value;
  const double is_there = is_first() && value ? 1.0 : 0.0;
  const auto both =
      total(torch::tensor({is_there, is_there > 0.0 ? *value : 0.0}, torch::kFloat64));
  if (both[0].item<double>() == 0.0) return std::nullopt;
  return both[1].item<double>();
}

}  // namespace kinalign
