// SPDX-License-Identifier: Apache-2.0
// Reads and writes truth.json, the truth about a simulated recording (docs/formats/truth.md).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/truth.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Returns the text of a file with the schema kinalign.truth/1.
std::string truth_json(const TrueRecording& truth);

/// Reads a truth. `name` appears in messages only. Fails if a key is missing or wrong, because a
/// wrong truth would give wrong comparisons. Also fails if the numbers of a clock's stamps and
/// times differ, or if its stamps do not rise.
Result<TrueRecording> read_truth(std::string_view json, const std::string& name);

}  // namespace kinalign
