// SPDX-License-Identifier: Apache-2.0
// Converts the JSON files of a BIDS data set to and from text. These functions throw no exceptions,
// although nlohmann's JSON library throws on invalid UTF-8 and on faults in a text by default.
#pragma once

#include "kinalign/core/error.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// The text with an indent of two blanks and a line end. Bytes that are not UTF-8 become U+FFFD.
std::string bids_json_text(const nlohmann::ordered_json& json);

/// Fails if the text is not a JSON object.
Result<nlohmann::ordered_json> parse_bids_json(std::string_view text, std::string_view file);

/// The text of a key; empty if the key is missing or its value is not a text.
std::string text_in(const nlohmann::ordered_json& object, const char* key);

/// The reference frames in a channels.json, with their SpatialAxes if these are stated.
std::map<std::string, std::optional<std::string>> frames_in(const nlohmann::ordered_json& object);

}  // namespace kinalign
