// SPDX-License-Identifier: Apache-2.0
// truth.json: the truth about a simulated recording. All keys: docs/formats/truth.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/truth.h"

#include <string>
#include <string_view>

namespace kinalign {

/// The text of a file, schema kinalign.truth/1.
std::string truth_json(const TrueRecording& truth);

/// Reads a truth. `name` appears in messages only. Fails if a key is missing or wrong, or if a
/// clock's stamps and times differ in number or do not rise.
/// A number that is missing is an error here: a comparison with a wrong truth would mislead.
Result<TrueRecording> read_truth(std::string_view json, const std::string& name);

}  // namespace kinalign
