// SPDX-License-Identifier: Apache-2.0
// Conversions between our arrays and LibTorch's tensors.
#pragma once

#include "kinalign/infer/safetensors.h"

#include <torch/torch.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace kinalign {

/// LibTorch counts in signed numbers.
inline std::int64_t whole(std::size_t value) { return static_cast<std::int64_t>(value); }

/// Copies the values into a tensor of that shape, which does not depend on the vector any more.
inline torch::Tensor to_torch(const std::vector<float>& values,
                              const std::vector<std::int64_t>& shape) {
  auto out = torch::empty(shape, torch::kFloat32);
  std::memcpy(out.data_ptr<float>(), values.data(), values.size() * sizeof(float));
  return out;
}

inline torch::Tensor to_torch(const Tensor& tensor) {
  return to_torch(tensor.values, {tensor.shape.begin(), tensor.shape.end()});
}

inline std::vector<float> values_of(const torch::Tensor& tensor) {
  const auto flat = tensor.detach().to(torch::kCPU).to(torch::kFloat32).contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

inline Tensor from_torch(const torch::Tensor& tensor) {
  Tensor out;
  for (const std::int64_t size : tensor.sizes())
    out.shape.push_back(static_cast<std::size_t>(size));
  out.values = values_of(tensor);
  return out;
}

}  // namespace kinalign
