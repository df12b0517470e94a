// SPDX-License-Identifier: Apache-2.0
// Our network: a temporal convolutional network over 61 frames. Its inputs are those of GlobalPose
// (Yi et al., 2024: angular velocity, the vertical, the root's own acceleration) and others, with a
// flag for each valid node. It is trained with the errors that a calibration leaves and with lost
// nodes.
#include "kinalign/learn/pose/pose_methods.h"

namespace kinalign {

namespace {

constexpr std::size_t inertial_width = 192;

Layer inertial_block(std::size_t dilation, bool causal) {
  return residual_block(inertial_width, dilation, causal, 0.15);
}

/// Blocks with dilations 1, 2, 4 and 8 and five frames each: 61 frames in all. The causal form uses
/// 60 earlier frames and no later ones.
Architecture inertial_layers(const PoseLayout& layout, bool causal) {
  return {layout.channels(),
          {{.kind = LayerKind::linear, .out = inertial_width},
           inertial_block(1, causal),
           inertial_block(2, causal),
           inertial_block(4, causal),
           inertial_block(8, causal),
           {.kind = LayerKind::linear, .out = layout.answers()}}};
}

Architecture inertial_architecture(const PoseLayout& layout) {
  return inertial_layers(layout, false);
}

Architecture inertial_online_architecture(const PoseLayout& layout) {
  return inertial_layers(layout, true);
}

}  // namespace

Layer residual_block(std::size_t width, std::size_t dilation, bool causal, double dropout) {
  return {.kind = LayerKind::sum,
          .branches = {{},
                       {{.kind = LayerKind::conv,
                         .out = width,
                         .kernel = 5,
                         .dilation = dilation,
                         .causal = causal},
                        {.kind = LayerKind::gelu},
                        {.kind = LayerKind::dropout, .rate = dropout},
                        {.kind = LayerKind::linear, .out = width}}}};
}

PoseMethod inertial_method() {
  return {.name = "inertial",
          .summary = "ours: a temporal convolutional network, trained with errors and lost nodes",
          .source = "kinalign",
          .architecture = inertial_architecture,
          .training = {},
          .options = {.steps = 4500, .rate = 2e-3, .rise = 0.1, .average = false}};
}

// A pose waits only for the later frames that the smoothing uses (docs/pose_live.md).
PoseMethod inertial_online_method() {
  PoseMethod out = inertial_method();
  out.name = "inertial-online";
  out.summary = "the same without later frames";
  out.architecture = inertial_online_architecture;
  return out;
}

}  // namespace kinalign
