// SPDX-License-Identifier: Apache-2.0
// A network as a list of layers: plain data that a model's file holds as JSON, that `infer` runs
// and that `learn` trains. Values between layers are [T,C]: T frames of C channels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

enum class LayerKind : std::uint8_t {
  linear,      // y = W x + b, frame by frame
  conv,        // over time, stride 1, as many frames out as in, zeros beyond both ends
  lstm,        // gates in PyTorch's order i, f, g, o
  gru,         // gates r, z, n
  layer_norm,  // over the channels of a frame, epsilon 1e-5
  relu,
  leaky_relu,  // `slope` below 0
  gelu,        // the exact one, with erf
  tanh,
  sigmoid,
  dropout,     // does something in training only
  slice,       // channels begin ... begin + out - 1
  max_pool,    // of each two frames the greater value; an odd last frame stays as it is
  unpool,      // each frame twice, at half its value; as many frames as the max_pool had
  sum,         // of all branches
  product,     // of all branches
  concat,      // channels of all branches, one behind the other
  along_time,  // each channel alone: the branch gets `window` frames of it as channels and answers
               // with as many; a frame's result is the mean over all windows that it lies in
};

/// One layer. Members that its kind does not name are as they stand here.
///
/// Tensors of the layer at `path` ("3", or "3.1.0": layer 3, branch 1, its layer 0), float32,
/// row-major, as PyTorch's modules have them:
///   linear      path.weight [out,in], path.bias [out]
///   conv        path.weight [out,in,kernel], path.bias [out]
///   lstm, gru   path.weight_ih_l0 [G out,in], path.weight_hh_l0 [G out,out], path.bias_ih_l0,
///               path.bias_hh_l0 [G out]; G 4, 3; and with _reverse behind the names if
///               bidirectional
///   layer_norm  path.weight [in], path.bias [in]
struct Layer {
  LayerKind kind = LayerKind::linear;
  std::size_t out = 0;         // linear, conv, slice: channels; lstm, gru: units of a direction
  std::size_t kernel = 1;      // conv: taps; odd unless causal
  std::size_t dilation = 1;    // conv: frames between taps
  bool causal = false;         // conv: sees this frame and earlier ones; else centred
  bool bidirectional = false;  // lstm, gru: 2 x out channels come out, forward first
  double slope = 0.01;         // leaky_relu
  double rate = 0.0;           // dropout: share of values set to 0
  std::size_t begin = 0;       // slice
  std::size_t window = 1;      // along_time: frames; fewer are filled up with the last one
  std::vector<std::vector<Layer>> branches =
      {};  // sum, product, concat; an empty one is the identity. along_time: one

  bool operator==(const Layer&) const = default;
};

struct Architecture {
  std::size_t inputs = 0;  // channels
  std::vector<Layer> layers;

  bool operator==(const Architecture&) const = default;
};

}  // namespace kinalign
