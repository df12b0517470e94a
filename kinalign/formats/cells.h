// SPDX-License-Identifier: Apache-2.0
// Splits one line of a table into numbers, without an allocation.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Value of `delimiter` under which any run of blanks and tabs delimits, also in front of the first
/// cell.
constexpr char runs_of_blanks = '\0';

/// Tells the parser where to put the content of a column. A column with neither number may hold
/// anything.
struct ColumnUse {
  int slot = -1;  // the column's number goes to values[slot]; -1: nowhere
  int text = -1;  // the column's text goes to texts[text]; -1: nowhere
};

/// Reads rows that all have the same columns. Blanks around a cell are dropped, unless the blank is
/// the delimiter. A cell in double quotes is the text between the quotes. Delimiters behind the
/// last column are tolerated.
/// The columns are known before the first row, so a row needs no look-up and no allocation.
class RowParser {
 public:
  RowParser() = default;
  RowParser(char delimiter, std::vector<ColumnUse> columns);

  /// Fills `values`, `missing` and `texts`. An empty cell and "nan" are missing. Fails, without a
  /// place, if the number of cells differs from the number of columns, or if a wanted cell holds no
  /// number below 1e15.
  Result<void> read(std::string_view line);

  std::size_t columns() const { return columns_.size(); }

  std::vector<double> values;           // [slots] 0 where missing
  std::vector<std::uint8_t> missing;    // [slots] 1: the cell was empty or "nan"
  std::vector<std::string_view> texts;  // views into the line read last
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

/// The cells of a line, trimmed and without quotes. Meant for header lines: it allocates.
std::vector<std::string> split_cells(std::string_view line, char delimiter);

/// `text` without blanks, tabs and line ends at both ends.
std::string_view trimmed(std::string_view text);

/// True if the cell says that there is no value: empty, or "nan" in any case.
bool says_missing(std::string_view cell);

/// True if the name can stand in a cell of tab-separated text: not empty, no tab, no line end.
bool fits_a_cell(std::string_view name);

}  // namespace kinalign
