// SPDX-License-Identifier: Apache-2.0
// Converts the JSON files of a BIDS data set to and from text. No exception leaves these functions.
// nlohmann throws on invalid UTF-8 and on faults in a text unless it is told not to.
#pragma once

#include "kinalign/core/error.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace kinalign {

/// Indented by two blanks, with a line end. Bytes that are no UTF-8 become U+FFFD.
std::string bids_json_text(const nlohmann::ordered_json& json);

/// Fails if the text is no JSON object.
Result<nlohmann::ordered_json> parse_bids_json(std::string_view text, std::string_view file);

}  // namespace kinalign
