// SPDX-License-Identifier: Apache-2.0
// Layers with their weights in the order in which the kernels read them.
#pragma once

#include "kinalign/infer/architecture.h"
#include "kinalign/infer/kernels.h"

#include <array>
#include <cstddef>
#include <new>
#include <string>
#include <vector>

namespace kinalign {

/// Allocates memory that begins at a cache line, so that no row of a panel spans two lines.
template <class T>
struct CacheAligned {
  using value_type = T;
  static constexpr std::align_val_t line{64};

  CacheAligned() = default;
  template <class Other>
  explicit CacheAligned(const CacheAligned<Other>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, line); }
  bool operator==(const CacheAligned&) const = default;
};

/// Weights and states. A vector with this allocator is used like any other.
using Values = std::vector<float, CacheAligned<float>>;

/// One matrix, or one for each tap, with its bias.
struct PackedWeights {
  std::size_t taps = 1, channels = 0, outputs = 0;
  Values weights;  // in the order of Product::weights
  Values bias;     // empty: no bias

  /// A product with these weights; the caller sets the frames.
  Product product() const;
};

/// Weights of one direction of a recurrent layer. The products with the input and with the state
/// are separate, because those with the input are computed for all frames at once.
struct DirectionWeights {
  PackedWeights from_input;  // lstm: the bias is the sum of both biases
  PackedWeights from_state;  // gru: has its own bias; lstm: none
};

/// A layer as it is run. Only the members of its kind are filled.
struct PreparedLayer {
  Layer layer;       // without branches
  std::string path;  // "3.1.0"
  std::size_t inputs = 0, outputs = 0;
  PackedWeights weights;                       // linear, conv
  std::array<DirectionWeights, 2> directions;  // lstm, gru: forward, reverse
  Values norm_weight, norm_bias;               // layer_norm
  std::vector<std::vector<PreparedLayer>> branches;
};

/// Applies relu, leaky_relu, gelu, tanh or sigmoid to values in place.
void apply_activation(const Kernels& kernels, const Layer& layer, float* values, std::size_t n);

/// The parts of a network that do not change between runs. Several threads may run one network at
/// the same time, because all changing values are in the workspace or the state.
struct PreparedNetwork {
  Architecture architecture;
  std::size_t outputs = 0;
  std::vector<PreparedLayer> layers;
  const Kernels* kernels = nullptr;
};

}  // namespace kinalign
