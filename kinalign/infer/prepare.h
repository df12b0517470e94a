// SPDX-License-Identifier: Apache-2.0
// From the tensors of a file to weights that the kernels read.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/prepared.h"
#include "kinalign/infer/safetensors.h"

#include <map>
#include <string>

namespace kinalign {

/// Fails where a tensor `prefix` + name of a valid architecture is missing, has another shape or a
/// value that is not finite.
Result<void> check_tensors(const Architecture& architecture,
                           const std::map<std::string, Tensor>& tensors, const std::string& prefix);

/// Checks the tensors and packs them. The rules are those of Network::make.
Result<PreparedNetwork> prepare(const Architecture& architecture,
                                const std::map<std::string, Tensor>& tensors,
                                const std::string& prefix);

}  // namespace kinalign
