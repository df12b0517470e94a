// SPDX-License-Identifier: Apache-2.0
// Numbers in little-endian order, as in recordings, in Noitom's packets and in XDF files.
// wire/bytes.h handles data in network order.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// The number at position `at`. All its bytes must be within `bytes`.
template <std::unsigned_integral T>
T little_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  assert(at <= bytes.size() && sizeof(T) <= bytes.size() - at);
  std::uint64_t value = 0;
  // The value is read byte by byte, so alignment and byte order of the machine do not matter.
  for (std::size_t i = sizeof(T); i-- > 0;) value = value << 8 | bytes[at + i];
  return static_cast<T>(value);
}

/// Writes a number to to[0] and the following bytes, which must exist.
template <std::unsigned_integral T, class Byte>
void put_little(T value, Byte* to) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    to[i] = static_cast<Byte>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU);
  }
}

/// Appends a number to a string or a vector of bytes.
template <std::unsigned_integral T, class Bytes>
void append_little(T value, Bytes& out) {
  typename Bytes::value_type bytes[sizeof(T)];
  put_little(value, bytes);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

}  // namespace kinalign
