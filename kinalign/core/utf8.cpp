// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/utf8.h"

namespace kinalign {

Character first_character(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  // The first byte determines how many bytes follow. 0xc0 and 0xc1 are invalid: they could only
  // begin a code that has a shorter form.
  const std::size_t more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc2 ? 1 : 0;
  char32_t code = more == 0 ? lead : lead & (0x3fU >> more);
  bool good = more == 0 ? lead < 0x80 : lead < 0xf5 && more < text.size();
  for (std::size_t k = 1; good && k <= more; ++k) {
    const auto next = static_cast<unsigned char>(text[k]);
    good = (next & 0xc0U) == 0x80;
    code = code << 6U | (next & 0x3fU);
  }
  // A smaller code has a shorter form, and only the shortest form is valid. Codes from 0xd800 to
  // 0xdfff are halves of UTF-16 pairs and not characters.
  constexpr char32_t least[] = {0, 0x80, 0x800, 0x10000};
  good = good && code >= least[more] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  return good ? Character{code, more + 1} : Character{};
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const Character next = first_character(text);
    if (!next.code) return false;
    text.remove_prefix(next.bytes);
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const Character next = first_character(text);
    const auto lead = static_cast<unsigned char>(text.front());
    if (next.code) {
      out += text.substr(0, next.bytes);
    } else {
      // Latin-1 has the codes 0x80 to 0xff, which take two bytes in UTF-8.
      out += {static_cast<char>(0xc0U | lead >> 6U), static_cast<char>(0x80U | (lead & 0x3fU))};
    }
    text.remove_prefix(next.bytes);
  }
  return out;
}

}  // namespace kinalign
