// SPDX-License-Identifier: Apache-2.0
// The name, hash and length of a whole file, as a take remembers its inputs.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/take/recording.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Reads all of the file. `doing`: the word that `progress` gets, "reading" or "hashing".
Result<InputFacts> facts_of(FileSystem& files, const std::string& path, std::string_view doing,
                            const Progress& progress);

}  // namespace kinalign
