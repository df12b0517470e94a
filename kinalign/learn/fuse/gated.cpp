// SPDX-License-Identifier: Apache-2.0
// Our network: a branch of temporal convolutions for each device. A gate weighs the branches
// channel by channel, depending on both devices' data. If a joint of the Kinect is missing or
// guessed, the gate reduces its channels and the nodes decide.
#include "kinalign/learn/fuse/fuse_methods.h"
#include "kinalign/learn/pose/pose_methods.h"

namespace kinalign {

namespace {

constexpr std::size_t gated_width = 160;

Layer gated_block(std::size_t dilation, bool causal) {
  return residual_block(gated_width, dilation, causal, 0.1);
}

/// One device's channels from `begin` on, their convolutions, and their half of the gate. The gate
/// reads the channels of both devices. It multiplies each channel of this branch by a factor
/// between 0 and 1.
std::vector<Layer> gated_branch(std::size_t begin, std::size_t channels, bool causal) {
  return {
      {.kind = LayerKind::product,
       .branches = {{{.kind = LayerKind::slice, .out = channels, .begin = begin},
                     {.kind = LayerKind::linear, .out = gated_width},
                     gated_block(1, causal),
                     gated_block(2, causal)},
                    {{.kind = LayerKind::conv, .out = gated_width, .kernel = 5, .causal = causal},
                     {.kind = LayerKind::sigmoid}}}}};
}

/// The receptive field is 61 frames: blocks with dilations 1, 2, 4 and 8, five frames each.
Architecture gated_layers(const FuseLayout& layout, bool causal) {
  const std::size_t kinect = layout.kinect_channels(), nodes = layout.node_channels();
  return {layout.channels(),
          {{.kind = LayerKind::sum,
            .branches = {gated_branch(0, kinect, causal), gated_branch(kinect, nodes, causal)}},
           gated_block(4, causal),
           gated_block(8, causal),
           {.kind = LayerKind::linear, .out = layout.answers()}}};
}

Architecture gated_architecture(const FuseLayout& layout) { return gated_layers(layout, false); }

Architecture gated_online_architecture(const FuseLayout& layout) {
  return gated_layers(layout, true);
}

}  // namespace

FuseMethod gated_method() {
  return {.name = "gated",
          .summary = "ours: a branch for each device, weighted by what each device measures",
          .source = "kinalign",
          .architecture = gated_architecture,
          .training = {},
          .options = {.steps = 2000, .rate = 2e-3, .rise = 0.1, .average = false}};
}

// Causal convolutions use no later frame, so the network needs no look-ahead on live frames.
FuseMethod gated_online_method() {
  FuseMethod out = gated_method();
  out.name = "gated-online";
  out.summary = "the same without later frames";
  out.architecture = gated_online_architecture;
  return out;
}

std::vector<FuseMethod> fuse_methods() {
  return {gated_method(), gated_online_method(), bilstm_method(Devices::both),
          bilstm_method(Devices::kinect), bilstm_method(Devices::nodes)};
}

}  // namespace kinalign
