// SPDX-License-Identifier: Apache-2.0
// Text on a terminal: the room there is, and the room that a text needs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinalign {

/// The defaults are those of a classic terminal.
struct TerminalSize {
  std::size_t rows = 24, columns = 80;
};
/// The size of the terminal behind a descriptor; the default if it is no terminal.
TerminalSize size_of(int fd);

/// Goes to the beginning of the current line, or of the first of `lines` lines that end at the
/// cursor, and erases each. Erasing everything below the top of the screen at once would make tmux
/// keep a copy.
std::string start_of_lines(std::size_t lines);

/// The columns that a text takes: one for each character, none for a colour.
std::size_t places(std::string_view text);

/// The rows that a line of so many columns takes on a terminal with `columns` columns.
std::size_t rows_of(std::size_t places, std::size_t columns);

/// The beginning of a text without colours that fits into `most` columns.
std::string_view first_places(std::string_view text, std::size_t most);

/// Breaks each line at blanks if it is wider than `width`. The rest of a line begins below the
/// line's second column or, without one, two blanks further right. Colours have no width.
std::string broken(std::string_view lines, std::size_t width);

}  // namespace kinalign
