// SPDX-License-Identifier: Apache-2.0
// The size of a terminal, and the room that a text takes on it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace kinalign {

/// The size of a terminal in characters. The defaults are those of a classic terminal.
struct TerminalSize {
  std::size_t rows = 24, columns = 80;
};
/// The size of the terminal at a descriptor. The defaults if the descriptor is no terminal.
TerminalSize size_of(int fd);

/// The text that erases the last `lines` lines, up to the cursor, and moves the cursor to the first
/// of them. Each line is erased by itself: if the whole screen were erased at once, tmux would keep
/// a copy.
std::string start_of_lines(std::size_t lines);

/// The number of columns that a text takes: one for each character, none for colours.
std::size_t places(std::string_view text);

/// The number of rows that a line of `places` columns takes on a terminal with `columns` columns.
std::size_t rows_of(std::size_t places, std::size_t columns);

/// The beginning of a text without colours, as much as fits into `most` columns.
std::string_view first_places(std::string_view text, std::size_t most);

/// Breaks each line that is wider than `width` at blanks. The rest of the line begins below the
/// line's second column. A line without a second column goes on two blanks further right. Colours
/// have no width.
std::string broken(std::string_view lines, std::size_t width);

}  // namespace kinalign
