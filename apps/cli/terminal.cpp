// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/terminal.h"

#include <sys/ioctl.h>

#include <algorithm>

namespace kinalign {

namespace {

/// The column in which the rest of a broken line begins: after "  space  " or "warning  ". If that
/// column is too far right, the rest is indented by two.
std::size_t text_column(std::string_view line) {
  constexpr std::size_t most = 24;
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", begin);
  if (gap == std::string_view::npos) return begin + 2;
  const std::size_t column = places(line.substr(0, line.find_first_not_of(' ', gap)));
  return column < most ? column : begin + 2;
}

/// Breaks one line. The line stays as it is if it fits, or if the terminal is too narrow for the
/// indent.
std::string broken_line(std::string_view line, std::size_t width) {
  const std::size_t indent = text_column(line);
  if (places(line) <= width || indent + 20 > width) return std::string(line);
  std::string out(line.substr(0, line.find_first_not_of(' ')));
  line.remove_prefix(out.size());
  std::size_t at = out.size();
  while (!line.empty()) {
    const std::size_t blanks = std::min(line.find_first_not_of(' '), line.size());
    const std::string_view word = line.substr(blanks, line.find(' ', blanks) - blanks);
    // A word wider than the terminal stays whole, even if the terminal cuts it.
    const bool fits = at + blanks + places(word) <= width || at <= indent;
    out += fits ? std::string(blanks, ' ') : "\n" + std::string(indent, ' ');
    at = (fits ? at + blanks : indent) + places(word);
    out += word;
    line.remove_prefix(blanks + word.size());
  }
  return out;
}

}  // namespace

TerminalSize size_of(int fd) {
  winsize reported{};
  TerminalSize size;
  if (::ioctl(fd, TIOCGWINSZ, &reported) != 0) return size;
  // Some terminals report 0 rows or columns; the defaults then stay.
  if (reported.ws_row > 1) size.rows = reported.ws_row;
  if (reported.ws_col > 1) size.columns = reported.ws_col;
  return size;
}

std::string start_of_lines(std::size_t lines) {
  std::string erased = "\r\x1b[K";
  for (std::size_t i = 1; i < lines; ++i) erased += "\x1b[A\x1b[K";
  return erased;
}

std::size_t places(std::string_view text) {
  std::size_t count = 0;
  bool colour = false;
  for (const char c : text) {
    // Colours are the only escape sequences in these texts. Each ends with an m.
    if (c == '\x1b') colour = true;
    // True for a byte within a UTF-8 character, after its first one.
    const bool goes_on = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
    if (!colour && !goes_on) ++count;
    if (c == 'm') colour = false;
  }
  return count;
}

std::size_t rows_of(std::size_t places, std::size_t columns) {
  return std::max<std::size_t>(1, (places + columns - 1) / columns);
}

std::string_view first_places(std::string_view text, std::size_t most) {
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++end) {
    const bool goes_on = (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U;
    if (!goes_on && count++ == most) break;
  }
  return text.substr(0, end);
}

std::string broken(std::string_view lines, std::size_t width) {
  std::string out;
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
    out += broken_line(line, width) + "\n";
  }
  return out;
}

}  // namespace kinalign
