// SPDX-License-Identifier: Apache-2.0
// truth.json, what is true of a simulated recording. Every key: docs/formats/truth.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/truth.h"

#include <string>
#include <string_view>

namespace kinalign {

/// Text of a file, schema kinalign.truth/1.
std::string truth_json(const TrueRecording& truth);

/// `name` appears in messages only. Fails where a key is missing or not what it should be, or where
/// a clock's stamps and times differ in number or do not rise.
Result<TrueRecording> read_truth(std::string_view json, const std::string& name);

}  // namespace kinalign
