// SPDX-License-Identifier: Apache-2.0
// SmoothNet: Zeng, Yang, Ju, Li, Wang, Xu, «SmoothNet: a plug-and-play network for refining human
// poses in videos», ECCV 2022, in the size of its released 3DPW configuration. The same weights
// smooth every coordinate of every joint, so the network can't learn the mean offset of a joint.
// The mean offset is added afterwards, as in the method `offset`.
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

namespace {

constexpr std::size_t smooth_window = 32, smooth_hidden = 512, smooth_narrow = 16;

/// A block x + f(x), where f is a network with a narrow middle layer.
Layer smooth_block() {
  return {.kind = LayerKind::sum,
          .branches = {{},
                       {{.kind = LayerKind::linear, .out = smooth_narrow},
                        {.kind = LayerKind::dropout, .rate = 0.5},
                        {.kind = LayerKind::leaky_relu, .slope = 0.2},
                        {.kind = LayerKind::linear, .out = smooth_hidden},
                        {.kind = LayerKind::dropout, .rate = 0.5},
                        {.kind = LayerKind::leaky_relu, .slope = 0.2}}}};
}

/// along_time runs the branch on each coordinate, in windows of 32 frames, and averages windows
/// that overlap.
Architecture smoothnet_architecture(const DenoiseLayout& layout) {
  const Layer along_time{.kind = LayerKind::along_time,
                         .window = smooth_window,
                         .branches = {{{.kind = LayerKind::linear, .out = smooth_hidden},
                                       {.kind = LayerKind::leaky_relu, .slope = 0.1},
                                       smooth_block(),
                                       {.kind = LayerKind::linear, .out = smooth_window}}}};
  return {layout.channels(), {chosen_positions(layout), along_time}};
}

}  // namespace

DenoiseMethod smoothnet_method() {
  return {.name = "smoothnet",
          .summary = "fully connected layers along time, behind the mean offset",
          .source = "Zeng et al., ECCV 2022",
          .architecture = smoothnet_architecture,
          .training = {.loss = {.distance = 1.0, .acceleration = 0.1, .bone = 0.0, .spread = 0.0},
                       .crop = smooth_window,
                       .answer_scale = 0.3,
                       .one_scale = true},
          .options = {.steps = 1200, .rate = 1e-3},
          .from_base = false};
}

}  // namespace kinalign
