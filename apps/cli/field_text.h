// SPDX-License-Identifier: Apache-2.0
// Options in the form in which people write them.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Sets the option from text ("0.5", "true", "slerp"); a vector of strings gets one more element.
/// Fails outside the range or the choices; the Error names no place.
/// Flags, variables and files all use it, so ranges and messages are the same for all.
Result<void> set_field(const Field& field, std::string_view text);

/// The value in the form that set_field() reads. Empty for an optional without value; vectors are
/// joined by ", ".
std::string field_text(const Field& field);

/// True if the option's flag stands alone: --double, not --double true.
bool is_switch(const Field& field);

/// The word after the flag in a help page: "NUMBER", "FILE", "spline|slerp"; "" for a switch.
std::string placeholder(const Field& field);

/// The flag of an option: gap_ms gives "--gap-ms".
std::string flag_of(std::string_view name);

/// The variable of an option: gap_ms gives "KINALIGN_GAP_MS".
std::string variable_of(std::string_view name);

/// The words as a choice: "a, b or c".
std::string any_of(const std::vector<std::string>& words);

/// The words between commas: "a,b" gives "a" and "b". The text "" gives one empty word.
std::vector<std::string> split_at_commas(const std::string& text);

}  // namespace kinalign
