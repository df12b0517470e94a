// SPDX-License-Identifier: Apache-2.0
// Computes the name, hash and length of a whole file, which a take stores for each input.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/take/recording.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Reads the whole file. `doing` is the word for `progress`: "reading" or "hashing".
Result<InputFacts> facts_of(FileSystem& files, const std::string& path, std::string_view doing,
                            const Progress& progress);

}  // namespace kinalign
