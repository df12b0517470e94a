// SPDX-License-Identifier: Apache-2.0
// Characters of UTF-8 (RFC 3629), for the texts in takes and in messages.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

struct Character {
  std::optional<char32_t> code;  // empty: no valid character begins at this byte
  std::size_t bytes = 1;
};

/// The first character of a text, which must not be empty.
Character first_character(std::string_view text);

bool is_utf8(std::string_view text);

/// The text without the byte order mark, which some programs write in front of UTF-8.
inline std::string_view without_byte_order_mark(std::string_view text) {
  return text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
}

/// Converts text to UTF-8. Bytes that do not belong to a valid character are read as Latin-1.
std::string as_utf8(std::string_view text);

}  // namespace kinalign
