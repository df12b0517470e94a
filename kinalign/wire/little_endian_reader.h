// SPDX-License-Identifier: Apache-2.0
// Reads the fields of a message in little-endian order, and converts between text and bytes.
#pragma once

#include "kinalign/wire/bytes.h"
#include "kinalign/wire/little_endian.h"

#include <string_view>

namespace kinalign {

/// A view of the same bytes with another type.
inline std::span<const std::uint8_t> octets(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
  // The bytes are not copied. The view is valid as long as `bytes` are.
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

using LittleEndianReader = FieldReader<std::endian::little>;

}  // namespace kinalign
