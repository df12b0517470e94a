// SPDX-License-Identifier: Apache-2.0
// A network as a list of layers. This plain data is stored as JSON in a model's file, run by
// `infer` and trained by `learn`. Values between layers are [T,C]: T frames of C channels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Kinds of layers. The order is that of `kind_rows` (layer_kinds.h). Files store the name of a
/// kind, so a kind may be added anywhere, but never renamed.
enum class LayerKind : std::uint8_t {
  linear,      // y = W x + b, frame by frame
  conv,        // over time, stride 1, as many frames out as in, zeros beyond both ends
  lstm,        // gates in PyTorch's order i, f, g, o
  gru,         // gates r, z, n
  layer_norm,  // over the channels of a frame, epsilon 1e-5
  relu,
  leaky_relu,  // `slope` for negative values
  gelu,        // exact form, with erf
  tanh,
  sigmoid,
  dropout,   // acts in training only
  slice,     // slice: keeps the channels begin ... begin + out - 1
  max_pool,  // the larger value of each pair of frames; an odd last frame is kept
  unpool,    // each frame twice, at half its value; as many frames as before the matching max_pool
  sum,       // sum of all branches
  product,   // product of all branches
  concat,    // channels of all branches, one after another
  /// Processes each channel separately. Its branch gets `window` frames of a channel as its input
  /// channels and returns as many values, one for each of these frames. A frame's result is the
  /// mean over all windows that contain it.
  along_time,
};

/// One layer. Members that its kind does not use keep the defaults below.
///
/// Tensors of the layer at `path`, float32, row-major, as in PyTorch's modules. The path "3" is
/// layer 3; "3.1.0" is layer 0 of branch 1 of layer 3. For an lstm G is 4, for a gru 3. If a layer
/// is bidirectional, its tensors exist a second time with _reverse after their names:
///   linear      path.weight [out,in], path.bias [out]
///   conv        path.weight [out,in,kernel], path.bias [out]
///   lstm, gru   path.weight_ih_l0 [G out,in], path.weight_hh_l0 [G out,out], path.bias_ih_l0,
///               path.bias_hh_l0 [G out]
///   layer_norm  path.weight [in], path.bias [in]
struct Layer {
  LayerKind kind = LayerKind::linear;
  std::size_t out = 0;         // linear, conv, slice: channels; lstm, gru: units per direction
  std::size_t kernel = 1;      // conv: taps; odd unless causal
  std::size_t dilation = 1;    // conv: distance between taps, frames
  bool causal = false;         // conv: uses this frame and earlier ones; false: centred
  bool bidirectional = false;  // lstm, gru: 2 x out output channels, forward first
  double slope = 0.01;         // leaky_relu: factor of negative values
  double rate = 0.0;           // dropout: share of values set to 0
  std::size_t begin = 0;       // slice: first channel
  std::size_t window = 1;      // along_time: frames per window
  /// The branches of sum, product and concat; an empty branch is the identity. A layer along_time
  /// has exactly one branch.
  std::vector<std::vector<Layer>> branches = {};

  bool operator==(const Layer&) const = default;
};

/// A network without its weights. `validate` (shapes.h) checks that its layers fit together.
struct Architecture {
  std::size_t inputs = 0;  // input channels
  std::vector<Layer> layers;

  bool operator==(const Architecture&) const = default;
};

}  // namespace kinalign
