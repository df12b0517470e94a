// SPDX-License-Identifier: Apache-2.0
// Converts options from the text that people write, and back.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/options.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Sets the option from text ("0.5", "true", "slerp"). For a vector of strings the text is added as
/// one more element. Fails if the value is outside the range or the choices; the Error names no
/// file or flag. Flags, variables and files all use this function, so they have the same ranges and
/// messages.
Result<void> set_field(const Field& field, std::string_view text);

/// The option's value as text that set_field() can read. Empty for an optional without a value. The
/// elements of a vector are joined by ", ".
std::string field_text(const Field& field);

/// True if the option's flag takes no value: --double, not --double true.
bool is_switch(const Field& field);

/// The word that stands for the value in a help page: "NUMBER", "FILE", "spline|slerp". Empty for a
/// switch.
std::string placeholder(const Field& field);

/// The flag of an option: gap_ms gives "--gap-ms".
std::string flag_of(std::string_view name);

/// The environment variable of an option: gap_ms gives "KINALIGN_GAP_MS".
std::string variable_of(std::string_view name);

/// Joins the words to a choice: "a, b or c".
std::string any_of(const std::vector<std::string>& words);

/// Splits a text at its commas: "a,b" gives "a" and "b". An empty text gives one empty word.
std::vector<std::string> split_at_commas(const std::string& text);

}  // namespace kinalign
