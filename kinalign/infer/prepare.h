// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/infer/prepared.h"
#include "kinalign/infer/safetensors.h"

#include <map>
#include <string>

namespace kinalign {

/// Checks the tensors and packs them. The rules are those of Network::make.
Result<PreparedNetwork> prepare(const Architecture& architecture,
                                const std::map<std::string, Tensor>& tensors,
                                const std::string& prefix);

}  // namespace kinalign
