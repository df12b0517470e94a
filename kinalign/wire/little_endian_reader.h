// SPDX-License-Identifier: Apache-2.0
// Reads the fields of a message in little-endian order. wire/bytes.h does the same for network
// order. Running past the end is not reported at once; check `complete` after the last field.
#pragma once

#include "kinalign/wire/little_endian.h"

#include <bit>
#include <string_view>
#include <type_traits>

namespace kinalign {

/// The same bytes as another type.
inline std::span<const std::uint8_t> octets(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
  // The bytes are not copied; the view is valid as long as they are.
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Reads fields from the front. Past the end it returns zeros, and `complete` is false.
class LittleEndianReader {
 public:
  explicit LittleEndianReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::integral T>
  T take() {
    const auto bytes = take_bytes(sizeof(T));
    return bytes.empty() ? T{0} : static_cast<T>(little_at<std::make_unsigned_t<T>>(bytes, 0));
  }
  float take_float() { return std::bit_cast<float>(take<std::uint32_t>()); }
  /// Returns `count` bytes, or none if fewer are left.
  std::span<const std::uint8_t> take_bytes(std::uint64_t count) {
    if (count > left()) {
      at_ = bytes_.size();
      complete_ = false;
      return {};
    }
    at_ += static_cast<std::size_t>(count);
    return bytes_.subspan(at_ - static_cast<std::size_t>(count), static_cast<std::size_t>(count));
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

}  // namespace kinalign
