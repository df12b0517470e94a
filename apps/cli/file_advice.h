// SPDX-License-Identifier: Apache-2.0
// The lines below a failure that say which file to name instead, or which command reads it.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// For a folder that was named instead of a file: the first recording in it. For a recording that a
/// bad disk can't read: `recover`. Empty for any other failure.
std::vector<std::string> file_advice(const Error& error);

}  // namespace kinalign
