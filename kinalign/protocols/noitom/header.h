// SPDX-License-Identifier: Apache-2.0
// The 64 bytes in front of a binary frame: two layouts under one pair of tokens.
#pragma once

#include "kinalign/protocols/noitom/frame.h"

namespace kinalign {

constexpr std::size_t noitom_header_size = 64;

struct NoitomHeader {
  NoitomFrame frame;        // without its values
  std::size_t values = 0;   // that follow, f32
  bool compressed = false;  // the old header's flag: what follows is no row of floats
};

/// FF DD in front and, where the bytes reach so far, FF EE behind.
bool has_noitom_tokens(std::span<const std::uint8_t> bytes);

/// Reads 64 bytes that have the tokens. Nothing where count and flags fit neither layout.
std::optional<NoitomHeader> parse_noitom_header(std::span<const std::uint8_t> bytes);

/// A header, or the beginning of one as far as version, count and flags, stands in front of
/// `bytes`.
bool begins_noitom_header(std::span<const std::uint8_t> bytes);

/// Of 64 bytes whose count and flags fit neither layout: the count that stands there. All layouts
/// have it in one place; the old one's is longer.
std::size_t stated_noitom_values(std::span<const std::uint8_t> bytes);

}  // namespace kinalign
