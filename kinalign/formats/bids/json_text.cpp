// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/json_text.h"

#include "kinalign/core/utf8.h"

#include <nlohmann/json.hpp>

namespace kinalign {

std::string bids_json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<nlohmann::ordered_json> parse_bids_json(std::string_view text, std::string_view file) {
  auto parsed = nlohmann::ordered_json::parse(without_byte_order_mark(text), nullptr, false);
  if (parsed.is_object()) return parsed;
  return refuse(file, "a JSON object",
                parsed.is_discarded() ? "text that is no JSON" : "another JSON value");
}

std::string text_in(const nlohmann::ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

std::map<std::string, std::optional<std::string>> frames_in(const nlohmann::ordered_json& object) {
  std::map<std::string, std::optional<std::string>> out;
  const auto frame = object.find("reference_frame");
  if (frame == object.end() || !frame->is_object()) return out;
  const auto levels = frame->find("Levels");
  if (levels == frame->end() || !levels->is_object()) return out;
  for (const auto& [name, level] : levels->items()) {
    auto& letters = out[name];
    // Levels may be texts without axes.
    if (!level.is_object()) continue;
    const auto axes = level.find("SpatialAxes");
    if (axes != level.end() && axes->is_string()) letters = axes->get<std::string>();
  }
  return out;
}

}  // namespace kinalign
