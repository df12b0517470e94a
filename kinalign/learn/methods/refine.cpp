// SPDX-License-Identifier: Apache-2.0
// Ours: a linear answer over nine frames, and what it leaves over by a small convolutional network
// over 35 frames. The spread of each joint is stated.
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
  const std::size_t out = layout.answers() + layout.outputs.size();
  const std::vector<Layer> straight{{.kind = LayerKind::slice, .out = 3 * layout.inputs.size()},
                                    {.kind = LayerKind::conv, .out = out, .kernel = 9}};
  const std::vector<Layer> correction{{.kind = LayerKind::conv, .out = refine_width, .kernel = 5},
                                      {.kind = LayerKind::relu},
                                      refine_block(1),
                                      refine_block(2),
                                      refine_block(4),
                                      refine_block(8),
                                      {.kind = LayerKind::dropout, .rate = 0.2},
                                      {.kind = LayerKind::linear, .out = out}};
  return {layout.channels(), {{.kind = LayerKind::sum, .branches = {straight, correction}}}};
}

}  // namespace

DenoiseMethod refine_method() {
  return {.name = "refine",
          .summary = "ours: a linear answer with a temporal convolutional correction",
          .source = "kinalign",
          .architecture = refine_architecture,
          .training = {.states_spread = true},
          .options = {.steps = 1200, .rate = 3e-3, .average = false},
          .begins_linear = true};
}

}  // namespace kinalign
