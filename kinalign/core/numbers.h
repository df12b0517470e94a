// SPDX-License-Identifier: Apache-2.0
// Numbers in text: exact both ways, never by the locale.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinalign {

/// Reads a decimal number at `at`, which must be followed, before or at `end`, by a character that
/// can't belong to it (a blank, a comma); `end` itself must be readable. Up to 15 digits go through
/// one integer and one exact division, which is correctly rounded and equals std::from_chars bit
/// for bit; the rest through std::from_chars. A leading '+' is taken; "nan" and "inf" are not.
/// Returns behind the number, or nullptr where none stands.
const char* parse_number(const char* at, const char* end, double& value);

/// The whole of `text` is one number (see parse_number).
bool parse_number(std::string_view text, double& value);

/// Digits behind the decimal point of "12.3400": 4. With an exponent or without a point: 0.
int decimals_of(std::string_view number);

/// Most characters that put_number writes.
constexpr std::size_t number_room = 40;

/// Writes `value` with `decimals` (0 to 15) digits behind the point where that reads back to the
/// same double, else in the shortest form that does. Returns behind the last character.
char* put_number(char* at, double value, int decimals);

}  // namespace kinalign
