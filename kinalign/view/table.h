// SPDX-License-Identifier: Apache-2.0
// A table as data. It can be written as text, Markdown, LaTeX, CSV or JSON with the same numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

/// Empty (monostate) if the value is not known.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
/// An absent value gives an empty cell. A zero would look like a perfect result.
inline Cell cell_of(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

/// A column. `key` never changes, because other programs read it; `title` may change.
struct TableColumn {
  std::string key;    // name in CSV and JSON: "height_cm"
  std::string title;  // title for readers: "height, cm"
  int decimals = 0;   // for readers; CSV and JSON have all digits
};

/// A table. A cell keeps its number until the table is written, because formats differ in the
/// number of digits.
struct Table {
  std::string caption;
  std::vector<TableColumn> columns;
  std::vector<std::vector<Cell>> rows;  // a row has a cell for each column
  bool has_sum = false;                 // the last row contains sums of the other rows
};

/// Returns a cell as text for readers: digits grouped by thousands, the column's decimals, "–" if
/// not known. Used for text, Markdown, LaTeX and HTML.
std::string cell_text(const Cell& cell, const TableColumn& column);
/// Returns which columns contain only numbers; these are right-aligned.
std::vector<bool> numeric_columns(const Table& table);

enum class TableFormat { text, markdown, latex, csv, json };

/// Returns the format by its name: "text", "markdown", "latex", "csv", "json"; absent for other
/// names.
std::optional<TableFormat> table_format(std::string_view name);

/// Returns the table in that format, ending with a line end. Text, Markdown and LaTeX group digits
/// by thousands. Text has aligned columns. CSV follows RFC 4180 with a line of keys, and lines end
/// with LF. JSON is an array of objects.
std::string written(const Table& table, TableFormat format);

}  // namespace kinalign
