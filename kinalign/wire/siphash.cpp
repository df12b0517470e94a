// SPDX-License-Identifier: Apache-2.0
// The names come from section 2 of the SipHash paper (see siphash.h). v0 to v3 are the state, and m
// is a word of the message.
#include "kinalign/wire/siphash.h"

#include <bit>
#include <cstddef>

namespace kinalign {

namespace {

/// Reads up to eight bytes, the lowest first.
std::uint64_t word(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

struct State {
  std::uint64_t v0, v1, v2, v3;

  void rounds(int n) {
    for (int i = 0; i < n; ++i) {
      v0 += v1, v2 += v3;
      v1 = std::rotl(v1, 13) ^ v0, v3 = std::rotl(v3, 16) ^ v2;
      v0 = std::rotl(v0, 32);
      v2 += v1, v0 += v3;
      v1 = std::rotl(v1, 17) ^ v2, v3 = std::rotl(v3, 21) ^ v0;
      v2 = std::rotl(v2, 32);
    }
  }
  // Two rounds per word, as the 2 in SipHash-2-4 says.
  void absorb(std::uint64_t m) {
    v3 ^= m;
    rounds(2);
    v0 ^= m;
  }
};

}  // namespace

std::uint64_t siphash_2_4(const SipHashKey& key, std::span<const std::uint8_t> bytes) {
  const std::uint64_t k0 = word(std::span(key).first(8));
  const std::uint64_t k1 = word(std::span(key).last(8));
  // The constants are the letters of "somepseudorandomlygeneratedbytes".
  State state{k0 ^ 0x736f6d6570736575, k1 ^ 0x646f72616e646f6d, k0 ^ 0x6c7967656e657261,
              k1 ^ 0x7465646279746573};
  const std::uint64_t length = bytes.size();
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) state.absorb(word(bytes.first(8)));
  // The last word contains the remaining bytes. Its top byte is the length modulo 256.
  state.absorb(length << 56 | word(bytes));
  state.v2 ^= 0xff;
  // Four rounds at the end, as the 4 in SipHash-2-4 says.
  state.rounds(4);
  return state.v0 ^ state.v1 ^ state.v2 ^ state.v3;
}

}  // namespace kinalign
