// SPDX-License-Identifier: Apache-2.0
// A table as data, and written as text, Markdown, LaTeX, CSV or JSON: the numbers are the same in
// all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinalign {

/// Empty where nothing is known.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;

struct TableColumn {
  std::string key;    // in CSV and JSON: "height_cm"
  std::string title;  // for people: "height, cm"
  int decimals = 0;   // of numbers, for people; CSV and JSON have all digits
};

struct Table {
  std::string caption;
  std::vector<TableColumn> columns;
  std::vector<std::vector<Cell>> rows;  // as wide as the columns
  bool has_sum = false;                 // the last row sums up the others
};

/// A cell for people: digits by thousands, the column's decimals, "–" where nothing is known.
std::string cell_text(const Cell& cell, const TableColumn& column);
/// Columns of numbers alone, which stand at the right.
std::vector<bool> numeric_columns(const Table& table);

enum class TableFormat { text, markdown, latex, csv, json };

/// "text", "markdown", "latex", "csv", "json"; absent for any other word.
std::optional<TableFormat> table_format(std::string_view name);
std::vector<std::string> table_format_names();

/// Ends in a line end. Text, Markdown and LaTeX group digits by thousands; text has columns of one
/// width; CSV is RFC 4180 with a line of keys and LF; JSON is an array of objects.
std::string written(const Table& table, TableFormat format);

}  // namespace kinalign
