// SPDX-License-Identifier: Apache-2.0
// Converts numbers to text and back, exactly, and independent of the locale.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>

namespace kinalign {

/// Reads a decimal number at `at`. A character that can't belong to it (a blank, a comma) must
/// follow before or at `end`, and `end` itself must be readable. Numbers of up to 15 digits take
/// one integer and one exact division, which is correctly rounded and equals std::from_chars bit
/// for bit; others use std::from_chars. A leading '+' is accepted, "nan" and "inf" are not. Returns
/// the position after the number, or nullptr if there is none.
const char* parse_number(const char* at, const char* end, double& value);

/// True if the whole of `text` is one number; see the other parse_number().
bool parse_number(std::string_view text, double& value);

/// True if the whole of `text` is one integer in the type's range, without blanks and without '+'.
template <std::integral Integer>
bool parse_integer(std::string_view text, Integer& value) {
  const char* end = text.data() + text.size();
  const auto [behind, fault] = std::from_chars(text.data(), end, value);
  return fault == std::errc{} && behind == end;
}

/// Larger numbers of any unit can't be meant, and are refused in files.
constexpr double largest_number = 1e15;

/// The number of digits after the decimal point: 4 for "12.3400". 0 with an exponent or without a
/// point.
int decimals_of(std::string_view number);

/// The most characters that put_number() writes.
constexpr std::size_t number_room = 40;

/// Writes `value` with `decimals` (0 to 15) digits after the point if that reads back as the same
/// double; otherwise in the shortest form that does. Returns the position after the last character.
char* put_number(char* at, double value, int decimals);
/// The characters of put_number() as a text.
std::string number_text(double value, int decimals);

}  // namespace kinalign
