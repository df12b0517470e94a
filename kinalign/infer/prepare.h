// SPDX-License-Identifier: Apache-2.0
// Converts the tensors of a file to weights in the order in which the kernels read them.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/prepared.h"
#include "kinalign/infer/safetensors.h"

#include <map>
#include <string>

namespace kinalign {

/// Fails if a tensor `prefix` + name of a valid architecture is missing, has another shape or
/// contains a value that is not finite.
Result<void> check_tensors(const Architecture& architecture,
                           const std::map<std::string, Tensor>& tensors, const std::string& prefix);

/// Checks the tensors and packs them. Fails in the cases in which Network::make fails. Called once
/// for each network. The values are copied, so `tensors` need not live longer.
Result<PreparedNetwork> prepare(const Architecture& architecture,
                                const std::map<std::string, Tensor>& tensors,
                                const std::string& prefix);

}  // namespace kinalign
