// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// What to do where --lab-key could not be read.
std::vector<std::string> key_advice(const Error& error);

}  // namespace kinalign
