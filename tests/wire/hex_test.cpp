// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/hex.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <string_view>

using namespace kinalign;

namespace {

using Three = std::array<std::uint8_t, 3>;

bool takes(std::string_view text) {
  Three bytes{};
  return take_hex(text, bytes);
}

}  // namespace

TEST_CASE("bytes are two lowercase digits each, and digits of either case are bytes") {
  std::string text(6, ' ');
  put_hex(Three{0x00, 0x9a, 0xff}, text);
  CHECK(text == "009aff");
  Three bytes{};
  CHECK(take_hex(std::string_view("009aFf"), bytes));
  CHECK(bytes == Three{0x00, 0x9a, 0xff});
}

TEST_CASE("a text that is not that many digits is none") {
  for (const std::string_view text :
       {"", "0102", "01020", "0102030", "01020g", "+10203", "01 203", "0x0203", "01020@", "01020`",
        "01020:", "01020/", "01020\xff"}) {
    CAPTURE(text);
    CHECK_FALSE(takes(text));
  }
  for (int byte = 0; byte < 256; ++byte) {  // the digits and no other character
    const char digit = static_cast<char>(byte);
    const bool known = std::string_view("0123456789abcdefABCDEF").find(digit) != std::string::npos;
    CAPTURE(byte);
    CHECK((hex_value(digit) >= 0) == known);
  }
}
