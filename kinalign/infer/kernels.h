// SPDX-License-Identifier: Apache-2.0
// The loops that take most of a network's time. kernels.cpp is compiled once for every processor
// and once for x86-64-v3 (AVX2 and FMA); the program chooses one build when it starts. Each result
// is summed in one fixed order for any number of frames. Results of the two builds differ by about
// 1e-6, because the second build fuses multiplication and addition.
#pragma once

#include <cstddef>

namespace kinalign {

/// Weights are stored in panels of this many outputs: [panels, taps, channels, panel_width]. The
/// last panel is padded with zeros.
inline constexpr std::size_t panel_width = 16;

/// The sum out[t,n] = bias[n] + sum over taps k and channels c of in[t,k,c] weights[k,c,n]. Frame
/// t, tap k begins at in + t in_stride + k tap_stride.
/// The same structure describes a linear layer (one tap), a convolution (taps that lie `dilation`
/// frames apart) and the gates of recurrent layers. `in` must hold the frames that the outermost
/// taps read; the caller pads them.
struct Product {
  const float* in = nullptr;
  std::size_t in_stride = 0, tap_stride = 0;
  std::size_t taps = 1, channels = 0;
  const float* weights = nullptr;
  const float* bias = nullptr;  // [panels, panel_width]; nullptr: the sums are added to `out`
  float* out = nullptr;
  std::size_t out_stride = 0, outputs = 0, frames = 0;
};

/// The functions of one build. A function with a single pointer changes the values in place.
struct Kernels {
  const char* name;
  void (*multiply)(const Product& product);
  void (*relu)(float* values, std::size_t n);
  void (*leaky_relu)(float* values, std::size_t n, float slope);
  void (*gelu)(float* values, std::size_t n);
  void (*tanh)(float* values, std::size_t n);
  void (*sigmoid)(float* values, std::size_t n);
  void (*add)(float* values, const float* more, std::size_t n);
  void (*scale_by)(float* values, const float* factors, std::size_t n);
  /// Normalises one frame. `in` and `out` may be the same.
  void (*layer_norm)(const float* in, float* out, const float* weight, const float* bias,
                     std::size_t channels);
  /// Computes the new cell and output of one step from the sums of the gates i, f, g and o.
  void (*lstm_gates)(const float* gates, float* cell, float* out, std::size_t units);
  /// Computes the new output of one step from the sums of the input and of the state, each for the
  /// gates r, z and n. `previous` and `out` may be the same.
  void (*gru_gates)(const float* from_input, const float* from_state, const float* previous,
                    float* out, std::size_t units);
};

/// The build for every processor. Tests compare it with the fastest one.
const Kernels& baseline_kernels();
/// The fastest build that this processor can run.
const Kernels& best_kernels();

}  // namespace kinalign
