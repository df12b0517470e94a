// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/methods/methods.h"

namespace kinalign {

std::vector<DenoiseMethod> denoise_methods() {
  return {refine_method(), cnn_method(), bra_method(), bra_p_method()};
}

}  // namespace kinalign
