// SPDX-License-Identifier: Apache-2.0
// Parses a frame of the string mode: `<index> <name> v v ... ||`.
#pragma once

#include "kinalign/protocols/noitom/frame.h"

#include <string_view>

namespace kinalign {

/// Parses the frame at the end of `text`, which ends with "||". Words in front of the frame are
/// skipped, because they belong to a frame whose end was lost. The result is empty if the text does
/// not end in a frame with one of the four counts of values.
std::optional<NoitomFrame> parse_noitom_text(std::string_view text);

/// The kinds of text that are not a frame.
enum class NoitomNoFrame : std::uint8_t {
  other_count,  // a frame `<index> <name> v v ...` with another number of values
  numbers,      // only numbers: the end of a frame whose beginning is missing
  other         // any other words
};
NoitomNoFrame judge_noitom_text(std::string_view text);

}  // namespace kinalign
