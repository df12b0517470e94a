// SPDX-License-Identifier: Apache-2.0
// The methods that are trained, a file each in this folder.
#pragma once

#include "kinalign/learn/method.h"

#include <vector>

namespace kinalign {

DenoiseMethod refine_method();
DenoiseMethod cnn_method();
DenoiseMethod bra_method();
DenoiseMethod bra_p_method();

std::vector<DenoiseMethod> denoise_methods();

}  // namespace kinalign
