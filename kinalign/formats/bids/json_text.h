// SPDX-License-Identifier: Apache-2.0
// Converts the JSON files of a BIDS data set to and from text. No exception leaves these functions.
// nlohmann throws on invalid UTF-8 and on faults in a text unless it is told not to.
#pragma once

#include "kinalign/core/error.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// Indented by two blanks, with a line end. Bytes that are no UTF-8 become U+FFFD.
std::string bids_json_text(const nlohmann::ordered_json& json);

/// Fails if the text is no JSON object.
Result<nlohmann::ordered_json> parse_bids_json(std::string_view text, std::string_view file);

/// The member's text; empty if there is none, or another value.
std::string text_in(const nlohmann::ordered_json& object, const char* key);

/// The reference frames that a channels.json describes, and their SpatialAxes; absent if none are
/// stated.
std::map<std::string, std::optional<std::string>> frames_in(const nlohmann::ordered_json& object);

}  // namespace kinalign
