// SPDX-License-Identifier: Apache-2.0
// A linear map of eleven stacked frames, after Wouda, Giuberti, Bellusci, Veltink, «Estimation of
// full-body poses using only five inertial sensors», Sensors 16(12), 2016, who learn from stacked
// orientations, too. Its weights are those of a convolution, found by ridge regression.
#include "kinalign/learn/pose/pose_methods.h"
#include "kinalign/learn/pose/ridge.h"

namespace kinalign {

namespace {

Layer wouda_layer(const PoseLayout& layout) {
  return {.kind = LayerKind::conv, .out = layout.answers(), .kernel = 11};
}

Architecture wouda_architecture(const PoseLayout& layout) {
  return {layout.channels(), {wouda_layer(layout)}};
}

void begin_wouda(const PoseTask& task, std::uint64_t seed, TorchNetwork& network) {
  set_ridge(task, seed, network.architecture().layers[0], "0", network);
}

}  // namespace

PoseMethod wouda_method() {
  return {.name = "wouda",
          .summary = "ridge regression over eleven frames",
          .source = "after Wouda et al., Sensors 16(12), 2016",
          .architecture = wouda_architecture,
          .training = {},
          .options = {.steps = 0},
          .begin = begin_wouda};
}

std::vector<PoseMethod> pose_methods() {
  return {inertial_method(), inertial_online_method(), dip_method(),
          dip_512_method(),  dip_robust_method(),      wouda_method()};
}

}  // namespace kinalign
