// SPDX-License-Identifier: Apache-2.0
// Parses a frame of the string mode: `<index> <name> v v ... ||`.
#pragma once

#include "kinalign/protocols/noitom/frame.h"

#include <string_view>

namespace kinalign {

/// Parses the frame at the end of `text`, which reaches to its "||". Words in front of it are
/// skipped: they belong to a frame that has lost its end. Empty if the text does not end in a frame
/// with one of the four counts of values.
std::optional<NoitomFrame> parse_noitom_text(std::string_view text);

/// Kinds of text that are no frame.
enum class NoitomNoFrame : std::uint8_t {
  other_count,  // a frame `<index> <name> v v ...` with another number of values
  numbers,      // only numbers: the end of a frame whose beginning is missing
  other         // any other words
};
NoitomNoFrame judge_noitom_text(std::string_view text);

}  // namespace kinalign
