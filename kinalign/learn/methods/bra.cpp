// SPDX-License-Identifier: Apache-2.0
// BRA: Li, Zhou, Zhu, Xie, Zhao, Liu, «Bidirectional recurrent autoencoder for 3D skeleton motion
// data refinement», Computers & Graphics 81, 2019. Its layer sizes are not published, so the sizes
// of the nearest published successor are used. BRA-P: Li, Zhu, Zheng, Li, IEEE Access 8, 2020. It
// is the same network, but its loss also compares features of a second network, which was trained
// on clean motion. In use the second network refines the output of the first one.
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

namespace {

constexpr std::size_t bra_units = 256;

Layer bra_recurrent() { return {.kind = LayerKind::lstm, .out = bra_units, .bidirectional = true}; }

/// Uses positions only; encoder and decoder are one bidirectional LSTM each.
/// The middle layer is narrow, as in an autoencoder. Dropout acts on the input of
/// each LSTM, because PyTorch ignores the dropout of an LSTM of one layer.
Architecture bra_architecture(const DenoiseLayout& layout) {
  return {layout.channels(),
          {{.kind = LayerKind::slice, .out = 3 * layout.inputs.size()},
           {.kind = LayerKind::linear, .out = bra_units},
           {.kind = LayerKind::tanh},
           {.kind = LayerKind::dropout, .rate = 0.2},
           bra_recurrent(),
           {.kind = LayerKind::linear, .out = bra_units},
           {.kind = LayerKind::dropout, .rate = 0.2},
           bra_recurrent(),
           {.kind = LayerKind::linear, .out = layout.answers()}}};
}

// The terms of the published loss: squared distance, bone lengths, smoothness. The network outputs
// positions relative to the root, which are larger than corrections, so their unit is larger, too.
DenoiseTraining bra_training() {
  return {.loss = {.distance = 0.0,
                   .square = 1.0,
                   .acceleration = 0.0,
                   .bone = 5e-3,
                   .smooth = 2e-2,
                   .spread = 0.0},
          .answer_scale = 0.3};
}

}  // namespace

DenoiseMethod bra_method() {
  return {.name = "bra",
          .summary = "bidirectional recurrent autoencoder",
          .source = "Li et al., Computers & Graphics 81, 2019",
          .architecture = bra_architecture,
          .training = bra_training(),
          .options = {.steps = 1200, .rate = 1e-3},
          .from_base = false};
}

DenoiseMethod bra_p_method() {
  DenoiseMethod out = bra_method();
  out.name = "bra-p";
  out.summary = "the same with a perceptual loss and a second network behind it";
  out.source = "Li et al., IEEE Access 8, 2020";
  out.perceptual = true;
  out.has_second = true;
  out.training.loss.hidden = 0.1;
  return out;
}

DenoiseMethod bra_p_plain_method() {
  DenoiseMethod out = bra_p_method();
  out.name = "bra-p-plain";
  out.summary = "bra-p without the second network behind it";
  out.has_second = false;
  return out;
}

}  // namespace kinalign
