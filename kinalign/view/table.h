// SPDX-License-Identifier: Apache-2.0
// A table as data, written as text, Markdown, LaTeX, CSV or JSON; the numbers are the same in all
// of them.
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
/// An absent value gives an empty cell and not a zero, which would look like a perfect mark.
inline Cell cell_of(const std::optional<double>& value) { return value ? Cell(*value) : Cell(); }

/// `key` never changes, because other programs read it; `title` may.
struct TableColumn {
  std::string key;    // in CSV and JSON: "height_cm"
  std::string title;  // for people: "height, cm"
  int decimals = 0;   // for people; CSV and JSON have all digits
};

/// Made by the verb, written here. A number stays a number until it is written, so that formats can
/// differ in its digits.
struct Table {
  std::string caption;
  std::vector<TableColumn> columns;
  std::vector<std::vector<Cell>> rows;  // each as wide as the columns
  bool has_sum = false;                 // the last row sums up the others
};

/// A cell for people: digits grouped by thousands, the column's decimals, "–" if not known.
/// For text, Markdown, LaTeX and HTML.
std::string cell_text(const Cell& cell, const TableColumn& column);
/// True for columns with only numbers, which are right-aligned.
std::vector<bool> numeric_columns(const Table& table);

enum class TableFormat { text, markdown, latex, csv, json };

/// The format by its name: "text", "markdown", "latex", "csv", "json"; absent for any other word.
std::optional<TableFormat> table_format(std::string_view name);

/// The table in that format; the text ends with a line end. Text, Markdown and LaTeX group digits
/// by thousands; text has aligned columns; CSV is RFC 4180 with a line of keys and LF; JSON is an
/// array of objects.
std::string written(const Table& table, TableFormat format);

}  // namespace kinalign
