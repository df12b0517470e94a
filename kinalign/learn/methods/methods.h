// SPDX-License-Identifier: Apache-2.0
// The methods that are trained, a file each in this folder.
#pragma once

#include "kinalign/learn/method.h"

#include <vector>

namespace kinalign {

DenoiseMethod refine_method();
DenoiseMethod refine_linear_method();
DenoiseMethod cnn_method();
DenoiseMethod cnn_manifold_method();
DenoiseMethod bra_method();
DenoiseMethod bra_p_method();
DenoiseMethod bra_p_plain_method();
DenoiseMethod smoothnet_method();

std::vector<DenoiseMethod> denoise_methods();

/// Of the input the positions of those joints alone that stand for the outputs, one for each.
Layer chosen_positions(const DenoiseLayout& layout);

}  // namespace kinalign
