// SPDX-License-Identifier: Apache-2.0
// The CRC-32 of Ethernet, zlib and PNG (IEEE 802.3: polynomial 04c11db7, bits reflected, initial
// value and final XOR all ones). The CRC detects damage. Only a MAC (message authentication code)
// detects forgery.
#pragma once

#include <cstdint>
#include <span>

namespace kinalign {

std::uint32_t crc32(std::span<const std::uint8_t> bytes);

}  // namespace kinalign
