// SPDX-License-Identifier: Apache-2.0
// Parses the JSON of our own files: no duplicate keys, no deep nesting.
#pragma once

#include "kinalign/core/error.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace kinalign {

/// Deeper texts are refused, because readers recurse once per level.
inline constexpr int most_json_depth = 64;

/// Fails if `text` is not JSON, nests too deeply or contains a key of an object twice. `name`
/// appears in messages only.
Result<nlohmann::json> parse_strict_json(std::string_view text, const std::string& name);

}  // namespace kinalign
