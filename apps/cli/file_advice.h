// SPDX-License-Identifier: Apache-2.0
// Advice below an error message that names another file or another command.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// If the user named a folder instead of a file, the advice names the first recording in it. If the
/// disk can't read the file, the advice is `ddrescue`. Empty for any other failure.
std::vector<std::string> file_advice(const Error& error);

}  // namespace kinalign
