// SPDX-License-Identifier: Apache-2.0
#include "kinalign/documents/json_values.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace kinalign {

using Json = nlohmann::ordered_json;

// nlohmann's operator[] requires that the key exists, so each function checks this first.
std::string text_at(const Json& json, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_string()) return "";
  std::string text = json[key].get<std::string>();
  // These texts are printed on terminals, which would interpret control characters.
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text;
}

double number_at(const Json& json, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_number()) return 0.0;
  // JSON has no infinity, but 1e999 is read as infinity.
  const auto number = json[key].get<double>();
  return std::isfinite(number) ? number : 0.0;
}

std::uint64_t count_at(const Json& json, const char* key) {
  // A negative number is an integer, but not an unsigned integer.
  if (!json.is_object() || !json.contains(key) || !json[key].is_number_unsigned()) return 0;
  return json[key].get<std::uint64_t>();
}

std::int64_t whole_at(const Json& json, const char* key, std::int64_t furthest) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_number_integer()) return 0;
  const auto whole = json[key].get<std::int64_t>();
  return whole > furthest || whole < -furthest ? 0 : whole;
}

const Json& list_at(const Json& json, const char* key) {
  // The function returns a reference, so the empty list must outlive the call.
  static const Json none = Json::array();
  if (!json.is_object() || !json.contains(key) || !json[key].is_array()) return none;
  return json[key];
}

}  // namespace kinalign
