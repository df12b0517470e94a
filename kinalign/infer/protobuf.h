// SPDX-License-Identifier: Apache-2.0
// Writes Protocol Buffers field by field (protobuf.dev/programming-guides/encoding).
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// A message. Fields are written in the order of the calls.
/// Wire types: 0 is a varint, 2 is bytes after their length, 5 is four bytes. A nested message is
/// written as bytes.
class ProtobufMessage {
 public:
  ProtobufMessage& add(unsigned field, std::int64_t value) {
    tag(field, 0);
    varint(static_cast<std::uint64_t>(value));
    return *this;
  }
  ProtobufMessage& add(unsigned field, float value) {
    tag(field, 5);
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned i = 0; i < 4; ++i) bytes_ += static_cast<char>(bits >> (8 * i) & 0xffU);
    return *this;
  }
  ProtobufMessage& add(unsigned field, std::string_view text) {
    tag(field, 2);
    varint(text.size());
    bytes_ += text;
    return *this;
  }
  ProtobufMessage& add(unsigned field, const ProtobufMessage& message) {
    return add(field, std::string_view(message.bytes_));
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void tag(unsigned field, unsigned type) { varint(std::uint64_t{field} << 3U | type); }
  /// Writes seven bits in each byte, the lowest first. The high bit of a byte says that more bytes
  /// follow.
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) bytes_ += static_cast<char>(value | 0x80U);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace kinalign
