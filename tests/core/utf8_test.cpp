// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/utf8.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

/// The UTF-8 bytes of a code point by RFC 3629, section 3.
std::string encoded(char32_t code) {
  const auto tail = [&](int place) {
    return static_cast<char>(0x80U | (code >> (6U * place) & 0x3fU));
  };
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) return {static_cast<char>(0xc0U | code >> 6U), tail(0)};
  if (code < 0x10000) return {static_cast<char>(0xe0U | code >> 12U), tail(1), tail(0)};
  return {static_cast<char>(0xf0U | code >> 18U), tail(2), tail(1), tail(0)};
}

}  // namespace

TEST_CASE("every character is read from its bytes, and from no fewer") {
  std::uint64_t wrong = 0;
  for (char32_t code = 0; code <= 0x10ffff; ++code) {
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    const std::string bytes = encoded(code);
    const Character all = first_character(bytes + "a");
    const bool right = surrogate ? !all.code : all.code == code && all.bytes == bytes.size();
    const bool cut = bytes.size() > 1 && is_utf8(bytes.substr(0, bytes.size() - 1));
    wrong += right && !cut && is_utf8(bytes) == !surrogate ? 0 : 1;
  }
  CHECK(wrong == 0);
}

TEST_CASE("a byte that begins no character is read as one of Latin-1") {
  CHECK(as_utf8("M\xfcller") == "M\xc3\xbcller");
  CHECK(as_utf8("M\xc3\xbcller") == "M\xc3\xbcller");
  CHECK(as_utf8("\xe9\xc3") == "\xc3\xa9\xc3\x83");
  CHECK(as_utf8("") == "");
}

TEST_CASE("bytes of other encodings are no UTF-8") {
  CHECK(is_utf8(""));
  CHECK(is_utf8("M\xc3\xbcller.bvh"));
  CHECK(!is_utf8("M\xfcller.bvh"));     // Latin-1
  CHECK(!is_utf8("\x80"));              // a tail alone
  CHECK(!is_utf8("\xc0\xaf"));          // '/' in two bytes
  CHECK(!is_utf8("\xe0\x80\xaf"));      // and in three
  CHECK(!is_utf8("\xf0\x80\x80\xaf"));  // and in four
  CHECK(!is_utf8("\xf4\x90\x80\x80"));  // after the last code point
  CHECK(!is_utf8("\xff"));
}
