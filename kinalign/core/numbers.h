// SPDX-License-Identifier: Apache-2.0
// Converts numbers to text and back, exactly and independently of the locale.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// Reads a decimal number at `at`. A character that can't belong to a number (a blank, a comma)
/// must follow at `end` or earlier, and `end` itself must be readable. Numbers of up to 15 digits
/// take one integer and one exact division. The result is correctly rounded and equals
/// std::from_chars bit for bit. Other numbers use std::from_chars. A leading '+' is accepted; "nan"
/// and "inf" are not. Returns the position after the number, or nullptr if there is no number.
const char* parse_number(const char* at, const char* end, double& value);

/// True if all of `text` is one number, by the rules of the other parse_number().
bool parse_number(std::string_view text, double& value);

/// True if all of `text` is one integer in the type's range. Blanks and '+' are not accepted.
template <std::integral Integer>
bool parse_integer(std::string_view text, Integer& value) {
  const char* end = text.data() + text.size();
  const auto [behind, fault] = std::from_chars(text.data(), end, value);
  return fault == std::errc{} && behind == end;
}

/// No measured quantity is larger than this in any unit, so files with larger numbers are refused.
constexpr double largest_number = 1e15;

/// The number of digits after the decimal point: 4 for "12.3400". The result is 0 if the number has
/// an exponent or no point.
int decimals_of(std::string_view number);

/// The most characters that put_number() writes.
constexpr std::size_t number_room = 40;

/// Writes `value` with `decimals` (0 to 15) digits after the point if this text reads back as the
/// same double. Otherwise writes the shortest text that does. Returns the position after the last
/// character.
char* put_number(char* at, double value, int decimals);
/// The characters of put_number() as a text.
std::string number_text(double value, int decimals);

/// Groups the digits before the point by thousands: "-2961581.50" gives "-2,961,581.50".
std::string grouped(std::string number);
inline std::string grouped(std::uint64_t number) { return grouped(std::to_string(number)); }

/// "1,234 lost, 3 late": counts with their words. Counts of 0 are left out.
std::string counts_in_words(const std::vector<std::pair<std::uint64_t, std::string>>& counts);

}  // namespace kinalign
