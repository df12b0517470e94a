// SPDX-License-Identifier: Apache-2.0
// The numbers of a page as text: rows of columns, rounded to a step, coded as differences from the
// rows before. assets/data.js reads it.
// Each column is coded separately, in blocks of 256 rows. A block begins with 2 bits (0: values, 1:
// differences, 2: differences of differences) and 5 bits k. Each number x follows as an unsigned
// one, 2x or -2x - 1: its part above k bits as that many 0 bits and a 1 bit, then k bits; from 20
// zeros on 20 zeros and 32 bits. k = 31: all numbers of the block are 0 and none follows. Bits go
// from the highest to the lowest of a byte; the bytes are Base64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// Base64 by RFC 4648, with padding.
/// Browsers decode it with atob().
std::string base64(std::string_view bytes);

/// `values` [K,columns], each as the nearest multiple of `step`, limited to 2^28 steps from zero. A
/// number that is not finite is stored as 0.
/// Motion is smooth, so second differences are small, and small numbers take few bits (Rice
/// coding).
std::string packed_series(std::span<const float> values, std::size_t columns, double step);

/// The same for small whole numbers.
std::string packed_series(std::span<const std::uint8_t> values, std::size_t columns);

}  // namespace kinalign
