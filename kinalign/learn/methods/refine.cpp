// SPDX-License-Identifier: Apache-2.0
// Ours: what the smoothed input joint and the mean offset leave over, corrected by a small
// convolutional network over 35 frames. The spread of each joint is stated.
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

namespace {

constexpr std::size_t refine_width = 128;

/// x + relu(conv(dropout(x))), over three frames that lie `dilation` apart.
Layer refine_block(std::size_t dilation) {
  return {.kind = LayerKind::sum,
          .branches = {
              {},
              {{.kind = LayerKind::dropout, .rate = 0.2},
               {.kind = LayerKind::conv, .out = refine_width, .kernel = 3, .dilation = dilation},
               {.kind = LayerKind::relu}}}};
}

Architecture refine_architecture(const DenoiseLayout& layout) {
  return {layout.channels(),
          {{.kind = LayerKind::conv, .out = refine_width, .kernel = 5},
           {.kind = LayerKind::relu},
           refine_block(1),
           refine_block(2),
           refine_block(4),
           refine_block(8),
           {.kind = LayerKind::dropout, .rate = 0.2},
           {.kind = LayerKind::linear, .out = layout.answers() + layout.outputs.size()}}};
}

}  // namespace

DenoiseMethod refine_method() {
  return {.name = "refine",
          .summary = "ours: a temporal convolutional correction of the smoothed input",
          .source = "kinalign",
          .architecture = refine_architecture,
          .training = {.states_spread = true},
          .options = {.steps = 1200, .rate = 3e-3, .average = false},
          .zero_last = true};
}

}  // namespace kinalign
