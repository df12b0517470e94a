// SPDX-License-Identifier: Apache-2.0
// CNN: the convolutional autoencoder of Holden, Saito, Komura, «A deep learning framework for
// character motion synthesis and editing», SIGGRAPH 2016, in paired mode: rough in, clean out.
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

namespace {

constexpr std::size_t cnn_hidden = 256, cnn_kernel = 25;

Architecture cnn_architecture(const DenoiseLayout& layout) {
  return {layout.channels(),
          {{.kind = LayerKind::slice, .out = 6 * layout.inputs.size()},
           {.kind = LayerKind::dropout, .rate = 0.25},
           {.kind = LayerKind::conv, .out = cnn_hidden, .kernel = cnn_kernel},
           {.kind = LayerKind::relu},
           {.kind = LayerKind::max_pool},
           {.kind = LayerKind::unpool},
           {.kind = LayerKind::dropout, .rate = 0.25},
           {.kind = LayerKind::conv, .out = layout.answers(), .kernel = cnn_kernel}}};
}

}  // namespace

DenoiseMethod cnn_method() {
  return {.name = "cnn",
          .summary = "convolutional autoencoder, paired",
          .source = "Holden et al., SIGGRAPH 2016",
          .architecture = cnn_architecture,
          .training = {.loss = {.distance = 0.0,
                                .square = 1.0,
                                .acceleration = 0.0,
                                .bone = 0.0,
                                .spread = 0.0},
                       .answer_scale = 0.3},
          .options = {.steps = 1200, .rate = 1e-3},
          .from_base = false};
}

}  // namespace kinalign
