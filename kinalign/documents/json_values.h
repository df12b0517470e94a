// SPDX-License-Identifier: Apache-2.0
// Members of JSON that may come from outside: one that is missing or of another type reads as
// nothing.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace kinalign {

/// Control characters in it become '?'.
std::string text_at(const nlohmann::ordered_json& json, const char* key);
/// 0 where none stands.
double number_at(const nlohmann::ordered_json& json, const char* key);
/// 0 where none stands; a negative number is none.
std::uint64_t count_at(const nlohmann::ordered_json& json, const char* key);
/// 0 where none stands, or one further than `furthest` from 0.
std::int64_t whole_at(const nlohmann::ordered_json& json, const char* key, std::int64_t furthest);
/// An empty array where none stands.
const nlohmann::ordered_json& list_at(const nlohmann::ordered_json& json, const char* key);

}  // namespace kinalign
