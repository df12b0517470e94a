// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/crc32.h"

#include <array>

namespace kinalign {

namespace {

// The effect of four bits on the remainder. A table for four bits has 64 bytes, and a table for
// eight bits has 1024. The node's firmware has little memory.
constexpr std::array<std::uint32_t, 16> nibbles = [] {
  std::array<std::uint32_t, 16> table{};
  for (std::uint32_t i = 0; i < 16; ++i) {
    std::uint32_t rest = i;
    for (int bit = 0; bit < 4; ++bit) rest = rest >> 1 ^ (rest % 2 != 0 ? 0xedb88320U : 0U);
    table[i] = rest;
  }
  return table;
}();

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t rest = 0xffffffff;
  // The lower four bits come first, because the bits of each byte are reflected.
  for (const std::uint8_t byte : bytes) {
    rest ^= byte;
    rest = rest >> 4 ^ nibbles[rest & 15];
    rest = rest >> 4 ^ nibbles[rest & 15];
  }
  return ~rest;
}

}  // namespace kinalign
