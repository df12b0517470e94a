// SPDX-License-Identifier: Apache-2.0
// Reads the fields of messages in network order (big-endian, RFC 1700) or in little-endian order,
// and writes datagrams in network order. A read past the end is only recorded. One check after all
// fields therefore replaces a check for each field.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

namespace kinalign {

/// Reads fields from the front. Past the end it returns zeros, and complete() is false.
template <std::endian order>
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::integral T>
  T take() {
    const auto bytes = take_bytes(sizeof(T));
    if (bytes.empty()) return T{0};
    std::uint64_t value = 0;
    // The value is read byte by byte, so alignment and byte order of the machine do not matter.
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value = value << 8 | bytes[order == std::endian::big ? i : sizeof(T) - 1 - i];
    }
    return static_cast<T>(value);
  }
  float take_float() { return std::bit_cast<float>(take<std::uint32_t>()); }
  template <std::size_t n>
  std::array<float, n> take_floats() {
    std::array<float, n> values{};
    for (float& value : values) value = take_float();
    return values;
  }
  /// Returns `count` bytes, or none if fewer are left.
  std::span<const std::uint8_t> take_bytes(std::uint64_t count) {
    if (count > left()) {
      // The rest is skipped too, so that no shorter field after the missing one is read.
      at_ = bytes_.size();
      complete_ = false;
      return {};
    }
    const auto taken = bytes_.subspan(at_, static_cast<std::size_t>(count));
    at_ += taken.size();
    return taken;
  }
  /// The bytes that are not read yet.
  std::span<const std::uint8_t> rest() const { return bytes_.subspan(at_); }

  bool complete() const { return complete_; }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool complete_ = true;
};
using ByteReader = FieldReader<std::endian::big>;

/// Writes fields one after another. A field that does not fit is not written, and complete() is
/// then false.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  void put(T value) {
    if (sizeof(T) > bytes_.size() - at_) {
      complete_ = false;
      return;
    }
    for (std::size_t i = sizeof(T); i-- > 0;) {
      bytes_[at_++] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
    }
  }
  void put_float(float value) { put(std::bit_cast<std::uint32_t>(value)); }

  bool complete() const { return complete_; }
  std::size_t written() const { return at_; }

 private:
  // The first `at_` bytes are written, and at_ <= bytes_.size(). A field is written completely or
  // not at all.
  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool complete_ = true;
};

}  // namespace kinalign
