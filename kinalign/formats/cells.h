// SPDX-License-Identifier: Apache-2.0
// One line of a table into numbers, without an allocation.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Stands for a delimiter: any run of blanks and tabs, also in front of the first cell.
constexpr char runs_of_blanks = '\0';

/// What is wanted of a column; a column of which nothing is wanted may hold anything.
struct ColumnUse {
  int slot = -1;  // its number goes to values[slot]
  int text = -1;  // its text goes to texts[text]
};

/// Reads rows of one shape. Blanks around a cell are no part of it (where the blank does not
/// delimit), a cell in double quotes is what stands between them, and delimiters behind the last
/// column are tolerated.
class RowParser {
 public:
  RowParser() = default;
  RowParser(char delimiter, std::vector<ColumnUse> columns);

  /// Fills `values`, `missing` and `texts`. Fails, without a place, where the number of cells is
  /// another or a wanted cell holds no number below 1e15; an empty cell and "nan" are missing.
  Result<void> read(std::string_view line);

  std::size_t columns() const { return columns_.size(); }

  std::vector<double> values;           // [slots] 0 where missing
  std::vector<std::uint8_t> missing;    // [slots] 1: the cell was empty or "nan"
  std::vector<std::string_view> texts;  // of the line read last
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

/// The cells of a line, trimmed and without quotes: for heads.
std::vector<std::string> split_cells(std::string_view line, char delimiter);

/// Without blanks, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text);

/// A cell that says that there is no value: empty, "nan" in any letters.
bool says_missing(std::string_view cell);

/// A name that can stand in a cell of tab-separated text: not empty, no tab, no line end.
bool fits_a_cell(std::string_view name);

}  // namespace kinalign
