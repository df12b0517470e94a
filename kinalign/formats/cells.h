// SPDX-License-Identifier: Apache-2.0
// Splits one line of a table into numbers without allocating memory.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A special delimiter: cells are separated by any number of blanks and tabs, which may also stand
/// in front of the first cell.
constexpr char runs_of_blanks = '\0';

/// Determines where the parser stores the content of a column. A column that is not stored may
/// contain anything.
struct ColumnUse {
  int slot = -1;  // index in RowParser::values; -1: not read as a number
  int text = -1;  // index in RowParser::texts; -1: not read as a text
};

/// Reads rows that all have the same columns. Blanks around a cell are dropped, unless the blank is
/// the delimiter. If a cell is in double quotes, the text between the quotes is used. Delimiters
/// after the last column are accepted. The columns are known before the first row, so that a row
/// needs no search and no allocation.
class RowParser {
 public:
  RowParser() = default;
  RowParser(char delimiter, std::vector<ColumnUse> columns);

  /// Fills `values`, `missing` and `texts`. An empty cell and "nan" count as missing. Fails if the
  /// number of cells differs from the number of columns, or if a cell that is read as a number
  /// contains no number below 1e15. The caller adds file and line to the error.
  Result<void> read(std::string_view line);

  std::size_t columns() const { return columns_.size(); }

  std::vector<double> values;           // [slots] 0 where missing
  std::vector<std::uint8_t> missing;    // [slots] 1: the cell is empty or "nan"
  std::vector<std::string_view> texts;  // views into the last line
  bool any_missing = false;

 private:
  template <bool runs>
  Result<void> read_cells(const char* at, const char* end);
  const char* number(const char* at, const char* end, int slot);
  const char* odd_number(const char* at, const char* end, int slot);
  const char* cell_end(const char* at, const char* end) const;
  bool delimits(char c) const;
  bool pads(char c) const;
  const char* read_cell(ColumnUse use, const char* at, const char* end);
  Result<void> nothing_behind(const char* at, const char* end) const;
  Failure wrong_count(std::size_t cells) const;
  static Failure no_number(std::size_t column, std::string_view cell);

  char delimiter_ = ',';
  std::vector<ColumnUse> columns_;
};

/// The cells of a line, without blanks around them and without quotes. It allocates memory, so it
/// is for header lines.
std::vector<std::string> split_cells(std::string_view line, char delimiter);

/// `text` without blanks, tabs and line ends at its beginning and end.
std::string_view trimmed(std::string_view text);

/// True if the cell is empty or "nan" in upper or lower case.
bool says_missing(std::string_view cell);

/// True if the name can be a cell of tab-separated text: not empty, without tabs and line ends.
bool fits_a_cell(std::string_view name);

}  // namespace kinalign
