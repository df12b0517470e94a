// SPDX-License-Identifier: Apache-2.0
// CRC-32 of files' contents (the one of wire/crc32.h) by zlib, which is made for megabytes.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string_view>

namespace kinalign {

/// Of `bytes` behind those that `before` is of.
inline std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0) {
  if (bytes.empty()) return before;  // zlib would begin anew
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace kinalign
