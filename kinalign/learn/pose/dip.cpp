// SPDX-License-Identifier: Apache-2.0
// DIP: Huang, Kaufmann, Aksan, Black, Hilliges, Pons-Moll, «Deep inertial poser», SIGGRAPH Asia
// 2018. It is a bidirectional LSTM with two layers, on rotations and accelerations relative to the
// root. It outputs six numbers per bone instead of nine, so that each output is a rotation. The
// loss is the squared distance of matrices and not the published likelihood, because the deviations
// that the likelihood estimates are not used here.
#include "kinalign/learn/pose/pose_methods.h"

namespace kinalign {

namespace {

/// The method's layers with `units` in each direction. Our default width is 256, because a window
/// of 26 frames with the published width takes 55 ms on one core. That is longer than a frame.
Architecture dip_layers(const PoseLayout& layout, std::size_t units) {
  const Layer recurrent{.kind = LayerKind::lstm, .out = units, .bidirectional = true};
  return {layout.channels(),
          {{.kind = LayerKind::dropout, .rate = 0.2},
           {.kind = LayerKind::linear, .out = units},
           {.kind = LayerKind::relu},
           recurrent,
           {.kind = LayerKind::dropout, .rate = 0.2},
           recurrent,
           {.kind = LayerKind::dropout, .rate = 0.2},
           {.kind = LayerKind::linear, .out = layout.answers()}}};
}

Architecture dip_architecture(const PoseLayout& layout) { return dip_layers(layout, 256); }

/// The layers with the published widths, and a layer of 256 before the output.
Architecture dip_512_architecture(const PoseLayout& layout) {
  const Layer recurrent{.kind = LayerKind::lstm, .out = 512, .bidirectional = true};
  return {layout.channels(),
          {{.kind = LayerKind::dropout, .rate = 0.2},
           {.kind = LayerKind::linear, .out = 512},
           {.kind = LayerKind::relu},
           recurrent,
           recurrent,
           {.kind = LayerKind::linear, .out = 256},
           {.kind = LayerKind::relu},
           {.kind = LayerKind::linear, .out = layout.answers()}}};
}

}  // namespace

PoseMethod dip_method() {
  return {.name = "dip",
          .summary = "bidirectional LSTM, trained without errors of nodes",
          .source = "Huang et al., SIGGRAPH Asia 2018",
          .inputs = PoseInputs::dip,
          .architecture = dip_architecture,
          .training = {.loss = {.matrices = 1.0, .position = 0.0, .acceleration = 0.0},
                       .errors = no_node_errors(),
                       .variety = no_variety,
                       .standardised = true},
          .options = {.steps = 900, .rate = 2e-3, .rise = 0.1, .average = false}};
}

PoseMethod dip_512_method() {
  PoseMethod out = dip_method();
  out.name = "dip-512";
  out.summary = "the same in the published width";
  out.architecture = dip_512_architecture;
  out.options.rate = 1e-3;
  return out;
}

PoseMethod dip_robust_method() {
  PoseMethod out = dip_method();
  out.name = "dip-robust";
  out.summary = "DIP's network, trained as ours";
  // The default training is that of our own method: errors of nodes, lost nodes, and all terms of
  // the loss.
  out.training = {};
  return out;
}

}  // namespace kinalign
