// SPDX-License-Identifier: Apache-2.0
// Characters of UTF-8 (RFC 3629), as takes hold their texts and messages show them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

struct Character {
  std::optional<char32_t> code;  // none: a byte that begins no character
  std::size_t bytes = 1;
};

/// The first character of a text that is not empty.
Character first_character(std::string_view text);

bool is_utf8(std::string_view text);

/// The text, a byte that begins no character read as one of Latin-1.
std::string as_utf8(std::string_view text);

}  // namespace kinalign
