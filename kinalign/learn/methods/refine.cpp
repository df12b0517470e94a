// SPDX-License-Identifier: Apache-2.0
// Our network: a small convolutional network over 35 frames corrects the smoothed input joint plus
// the mean offset. It also outputs the spread (the expected error) of each joint. The second form
// adds a linear map of nine frames. It is better for people, rooms and cameras of the training data
// and worse for others (docs/models.md).
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

namespace {

constexpr std::size_t refine_width = 128;

/// A residual block: x + relu(conv(dropout(x))), where conv covers three frames, `dilation` apart.
/// With small weights its output is its input, so gradients reach the first layers.
Layer refine_block(std::size_t dilation) {
  return {.kind = LayerKind::sum,
          .branches = {
              {},
              {{.kind = LayerKind::dropout, .rate = 0.2},
               {.kind = LayerKind::conv, .out = refine_width, .kernel = 3, .dilation = dilation},
               {.kind = LayerKind::relu}}}};
}

std::size_t refine_outputs(const DenoiseLayout& layout) {
  return layout.answers() + layout.outputs.size();
}

/// Five frames, then blocks that reach 1, 2, 4 and 8 frames to each side: 35 frames in all.
std::vector<Layer> correction(const DenoiseLayout& layout) {
  return {{.kind = LayerKind::conv, .out = refine_width, .kernel = 5},
          {.kind = LayerKind::relu},
          refine_block(1),
          refine_block(2),
          refine_block(4),
          refine_block(8),
          {.kind = LayerKind::dropout, .rate = 0.2},
          {.kind = LayerKind::linear, .out = refine_outputs(layout)}};
}

Architecture refine_architecture(const DenoiseLayout& layout) {
  return {layout.channels(), correction(layout)};
}

Architecture refine_linear_architecture(const DenoiseLayout& layout) {
  const std::vector<Layer> linear{
      {.kind = LayerKind::slice, .out = 3 * layout.inputs.size()},
      {.kind = LayerKind::conv, .out = refine_outputs(layout), .kernel = 9}};
  return {layout.channels(), {{.kind = LayerKind::sum, .branches = {linear, correction(layout)}}}};
}

}  // namespace

DenoiseMethod refine_method() {
  return {.name = "refine",
          .summary = "ours: a temporal convolutional correction of the smoothed input",
          .source = "kinalign",
          .architecture = refine_architecture,
          .training = {.states_spread = true},
          .options = {.steps = 1200, .rate = 3e-3, .average = false},
          .begins = Begins::as_base};
}

DenoiseMethod refine_linear_method() {
  DenoiseMethod out = refine_method();
  out.name = "refine-linear";
  out.summary =
      "the same, added to a linear answer, for people and rooms like those of the training";
  out.architecture = refine_linear_architecture;
  out.begins = Begins::linear;
  return out;
}

}  // namespace kinalign
