// SPDX-License-Identifier: Apache-2.0
// Members of JSON that may come from another program: a member that is missing or of another type
// reads as a default.
// A reader that must refuse such members does not use these functions.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace kinalign {

/// The text with control characters replaced by '?'; empty if there is none.
std::string text_at(const nlohmann::ordered_json& json, const char* key);
/// 0 if there is no number.
double number_at(const nlohmann::ordered_json& json, const char* key);
/// 0 if there is no number, or a negative one.
std::uint64_t count_at(const nlohmann::ordered_json& json, const char* key);
/// 0 if there is no number, or one whose absolute value is above `furthest`.
std::int64_t whole_at(const nlohmann::ordered_json& json, const char* key, std::int64_t furthest);
/// An empty array if there is none.
const nlohmann::ordered_json& list_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace kinalign
