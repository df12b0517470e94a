// SPDX-License-Identifier: Apache-2.0
// The lines below a failure that name another file or another command.
#pragma once

#include "kinalign/core/error.h"

#include <string>
#include <vector>

namespace kinalign {

/// If a folder was named instead of a file: its first recording. If a disk can't
/// read the file: `ddrescue`. Empty for any other failure.
std::vector<std::string> file_advice(const Error& error);

}  // namespace kinalign
