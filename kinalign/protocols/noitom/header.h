// SPDX-License-Identifier: Apache-2.0
// Parses the 64 bytes in front of a binary frame. Two layouts share one pair of tokens.
#pragma once

#include "kinalign/protocols/noitom/frame.h"

namespace kinalign {

constexpr std::size_t noitom_header_size = 64;

/// Content of a header whose count and flags agree with each other.
struct NoitomHeader {
  NoitomFrame frame;        // without its values
  std::size_t values = 0;   // number of values (f32) after the header
  bool compressed = false;  // flag of the old header: the values are compressed
};

/// True if the bytes begin with FF DD and, if there are 64 of them, end with FF EE.
bool has_noitom_tokens(std::span<const std::uint8_t> bytes);

/// Parses 64 bytes that have the tokens. Empty if count and flags fit neither layout.
std::optional<NoitomHeader> parse_noitom_header(std::span<const std::uint8_t> bytes);

/// True if `bytes` begin with a header, or with the part of one up to version, count and flags.
bool begins_noitom_header(std::span<const std::uint8_t> bytes);

/// The number of values that a header states whose count and flags fit neither layout. All layouts
/// have the count at the same position; the old one's field is longer.
std::size_t stated_noitom_values(std::span<const std::uint8_t> bytes);

}  // namespace kinalign
