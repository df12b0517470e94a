// SPDX-License-Identifier: Apache-2.0
// Reads members of JSON that may come from another program. If a member is missing or has another
// type, the result is a default. Code that must refuse such members does not use these functions.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace kinalign {

/// Returns the text with control characters replaced by '?'; empty if the member is no text.
std::string text_at(const nlohmann::ordered_json& json, const char* key);
/// Returns the number; 0 if the member is no number.
double number_at(const nlohmann::ordered_json& json, const char* key);
/// Returns the count; 0 if the member is no number or negative.
std::uint64_t count_at(const nlohmann::ordered_json& json, const char* key);
/// Returns the integer; 0 if the member is no integer or its absolute value exceeds `furthest`.
std::int64_t whole_at(const nlohmann::ordered_json& json, const char* key, std::int64_t furthest);
/// Returns the array; an empty array if the member is no array.
const nlohmann::ordered_json& list_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace kinalign
