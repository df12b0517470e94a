// SPDX-License-Identifier: Apache-2.0
// CNN: the convolutional autoencoder of Holden, Saito, Komura, «A deep learning framework for
// character motion synthesis and editing», SIGGRAPH 2016. The paired form learns from rough input
// and clean output. The manifold form, as published, learns from clean motion only, with a quarter
// of its inputs dropped. In use it maps a rough motion to the clean motion with the same code.
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

namespace {

constexpr std::size_t cnn_hidden = 256, cnn_kernel = 25;

/// The layers: input channels `seen`, the code, and the output. Kernels of 25 frames, 256 hidden
/// channels, pooling by 2 and dropout of 0.25 are those of the released code. Pooling keeps the
/// larger of two frames. In training its inverse puts the value into a random one of the two
/// frames.
Architecture autoencoder(const DenoiseLayout& layout, const Layer& seen) {
  return {layout.channels(),
          {seen,
           {.kind = LayerKind::dropout, .rate = 0.25},
           {.kind = LayerKind::conv, .out = cnn_hidden, .kernel = cnn_kernel},
           {.kind = LayerKind::relu},
           {.kind = LayerKind::max_pool},
           {.kind = LayerKind::unpool},
           {.kind = LayerKind::dropout, .rate = 0.25},
           {.kind = LayerKind::conv, .out = layout.answers(), .kernel = cnn_kernel}}};
}

/// Uses positions and their differences.
Architecture cnn_architecture(const DenoiseLayout& layout) {
  return autoencoder(layout, {.kind = LayerKind::slice, .out = 6 * layout.inputs.size()});
}

/// Uses positions of the output joints, for which the Kinect's joints are used later. Input and
/// output have one scale (`one_scale`), as an autoencoder needs it.
Architecture manifold_architecture(const DenoiseLayout& layout) {
  return autoencoder(layout, chosen_positions(layout));
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

DenoiseMethod cnn_manifold_method() {
  DenoiseMethod out = cnn_method();
  out.name = "cnn-manifold";
  out.summary = "the same, of clean motion alone";
  out.architecture = manifold_architecture;
  out.training.one_scale = true;
  out.training.from_truth = true;
  return out;
}

}  // namespace kinalign
