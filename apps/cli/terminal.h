// SPDX-License-Identifier: Apache-2.0
// Text on a terminal: how much room there is, and how much it takes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinalign {

struct TerminalSize {
  std::size_t rows = 24, columns = 80;
};
/// Of what a descriptor leads to; the usual one where that is no terminal.
TerminalSize size_of(int fd);

/// To the beginning of a line, or of the first of so many, of which the last is not ended; all are
/// erased, each by itself: who erases all that is below the screen's first place makes tmux keep a
/// copy of it.
std::string start_of_lines(std::size_t lines);

/// That a text takes: a character each, none for a colour.
std::size_t places(std::string_view text);

/// Rows that a line of so many places takes on a terminal that breaks it at `columns`.
std::size_t rows_of(std::size_t places, std::size_t columns);

/// As much of a text without colours as has room in so many places.
std::string_view first_places(std::string_view text, std::size_t most);

/// Whole lines, each broken at blanks where it is wider than `width`; what goes on stands below the
/// line's second column or, where there is none, two blanks further in. Colours have no width.
std::string broken(std::string_view lines, std::size_t width);

}  // namespace kinalign
