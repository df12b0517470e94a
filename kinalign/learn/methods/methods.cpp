// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

std::vector<DenoiseMethod> denoise_methods() {
  return {refine_method(), refine_linear_method(), cnn_method(),         cnn_manifold_method(),
          bra_method(),    bra_p_method(),         bra_p_plain_method(), smoothnet_method()};
}

// If an input joint stands for several outputs, it is selected several times.
Layer chosen_positions(const DenoiseLayout& layout) {
  Layer out{.kind = LayerKind::concat};
  for (const std::size_t joint : inputs_of_outputs(layout)) {
    out.branches.push_back({{.kind = LayerKind::slice, .out = 3, .begin = 3 * joint}});
  }
  return out;
}

}  // namespace kinalign
