// SPDX-License-Identifier: Apache-2.0
// A frame of the string mode: `<index> <name> v v ... ||`.
#pragma once

#include "kinalign/protocols/noitom/frame.h"

#include <string_view>

namespace kinalign {

/// The frame that ends where `text` does, before its "||"; what stands in front of it is passed
/// over: a frame that has lost its end. Nothing where none of the four counts of values stands
/// there.
std::optional<NoitomFrame> parse_noitom_text(std::string_view text);

/// What a text is that is no frame.
enum class NoitomNoFrame : std::uint8_t {
  other_count,  // ends as a frame does, `<index> <name> v v ...`, of another number of values
  numbers,      // nothing but numbers: the end of a frame, its beginning is not there
  other         // any other words
};
NoitomNoFrame judge_noitom_text(std::string_view text);

}  // namespace kinalign
