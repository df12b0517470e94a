// SPDX-License-Identifier: Apache-2.0
// Converts keys and hashes to text and back: two hexadecimal digits per byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// Writes lowercase digits. `out` must have two characters per byte.
constexpr void put_hex(std::span<const std::uint8_t> bytes, std::span<char> out) {
  constexpr char digits[] = "0123456789abcdef";
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    out[2 * i] = digits[bytes[i] >> 4];
    out[2 * i + 1] = digits[bytes[i] & 15];
  }
}

/// The value of a digit in either case, 0 to 15; -1 if the character is not a digit.
constexpr int hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  // This bit makes a letter lower case.
  const char lower = static_cast<char>(digit | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// Fills `bytes`. Returns false unless the text consists of exactly two digits per byte.
constexpr bool take_hex(std::span<const char> text, std::span<std::uint8_t> bytes) {
  if (text.size() != 2 * bytes.size()) return false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int high = hex_value(text[2 * i]), low = hex_value(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    bytes[i] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return true;
}

}  // namespace kinalign
