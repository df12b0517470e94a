// SPDX-License-Identifier: Apache-2.0
// Parses the 64 bytes in front of a binary frame. Two layouts exist. Both begin and end with the
// same tokens (two fixed bytes).
#pragma once

#include "kinalign/protocols/noitom/frame.h"

namespace kinalign {

constexpr std::size_t noitom_header_size = 64;

/// The content of a header whose count and flags agree.
struct NoitomHeader {
  NoitomFrame frame;        // the frame without its values
  std::size_t values = 0;   // number of 32-bit floats after the header
  bool compressed = false;  // flag of the old header for compressed values
};

/// True if the bytes begin with FF DD. If there are at least 64 bytes, the header must also end
/// with FF EE.
bool has_noitom_tokens(std::span<const std::uint8_t> bytes);

/// Parses 64 bytes that have the tokens. The result is empty if count and flags fit neither layout.
std::optional<NoitomHeader> parse_noitom_header(std::span<const std::uint8_t> bytes);

/// True if `bytes` begin with a header, or with its part up to version, count and flags.
bool begins_noitom_header(std::span<const std::uint8_t> bytes);

/// The number of values that a header states although count and flags fit neither layout. Both
/// layouts have the count at the same position, and the old layout's field is longer.
std::size_t stated_noitom_values(std::span<const std::uint8_t> bytes);

}  // namespace kinalign
