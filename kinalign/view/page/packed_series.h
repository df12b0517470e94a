// SPDX-License-Identifier: Apache-2.0
// The numbers of a page as compact text; assets/data.js reads it. The numbers are rounded to a step
// and coded as differences from earlier rows.
//
// Each column is coded separately, in blocks of 256 rows. A block begins with 2 bits (0: values, 1:
// differences, 2: differences of differences) and 5 bits for k. Each number x is made unsigned: 2x,
// or -2x - 1 if negative. Its upper part (above k bits) is written as that many 0 bits and a 1 bit;
// then k bits follow. If there would be 20 zeros or more, 20 zeros and all 32 bits are written. k =
// 31: all numbers of the block are 0, and no bits follow. Each byte is filled from the highest bit.
// The bytes are written in Base64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// Returns Base64 by RFC 4648, with padding. Browsers decode it with atob().
std::string base64(std::string_view bytes);

/// Packs `values` [K,columns] as the nearest multiples of `step`, limited to 2^28 steps from zero.
/// A number that is not finite is stored as 0. Motion is smooth, so second differences are small,
/// and small numbers need few bits (Rice coding).
std::string packed_series(std::span<const float> values, std::size_t columns, double step);

/// Packs small integers in the same way.
std::string packed_series(std::span<const std::uint8_t> values, std::size_t columns);

}  // namespace kinalign
