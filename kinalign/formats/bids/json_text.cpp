// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/json_text.h"

#include <nlohmann/json.hpp>

namespace kinalign {

std::string bids_json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<nlohmann::ordered_json> parse_bids_json(std::string_view text, std::string_view file) {
  // A byte order mark.
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  auto parsed = nlohmann::ordered_json::parse(text, nullptr, false);
  if (parsed.is_object()) return parsed;
  return Failure(Error{std::string(file), 0, "a JSON object",
                       parsed.is_discarded() ? "text that is no JSON" : "another JSON value"});
}

}  // namespace kinalign
