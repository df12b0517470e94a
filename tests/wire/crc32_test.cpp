// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/crc32.h"

#include <doctest/doctest.h>

#include <array>
#include <string_view>

using namespace kinalign;

namespace {

std::uint32_t crc32_of(std::string_view text) {
  return crc32({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

TEST_CASE("a CRC-32 is the one of Ethernet and zlib") {
  CHECK(crc32_of("123456789") == 0xcbf43926);  // the check value of the catalogues
  CHECK(crc32_of("") == 0);
  CHECK(crc32_of("The quick brown fox jumps over the lazy dog") == 0x414fa339);
  CHECK(crc32(std::array<std::uint8_t, 32>{}) == 0x190a55ad);  // zlib.crc32(bytes(32))
}
