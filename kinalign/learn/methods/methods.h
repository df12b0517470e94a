// SPDX-License-Identifier: Apache-2.0
// The methods that are trained, one file for each in this folder.
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

/// All methods, in the order in which they are listed for users.
std::vector<DenoiseMethod> denoise_methods();

/// A layer that selects, for each output, the position of the input joint that stands for it.
Layer chosen_positions(const DenoiseLayout& layout);

}  // namespace kinalign
