// SPDX-License-Identifier: Apache-2.0
#include "kinalign/view/table.h"

#include "kinalign/core/numbers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace kinalign {

namespace {

/// The values of the option --format.
constexpr std::array<std::pair<std::string_view, TableFormat>, 5> formats{
    {{"text", TableFormat::text},
     {"markdown", TableFormat::markdown},
     {"latex", TableFormat::latex},
     {"csv", TableFormat::csv},
     {"json", TableFormat::json}}};

/// Returns the text with some characters replaced.
std::string replaced(std::string_view text,
                     const std::vector<std::pair<char, std::string_view>>& by) {
  std::string out;
  for (const char c : text) {
    const auto found =
        std::find_if(by.begin(), by.end(), [c](const auto& p) { return p.first == c; });
    if (found == by.end()) {
      out += c;
    } else {
      out += found->second;
    }
  }
  return out;
}

/// Escapes characters that would end a cell, begin HTML or mean emphasis.
std::string for_markdown(std::string_view text) {
  return replaced(text, {{'|', "\\|"}, {'\n', " "}, {'<', "&lt;"}, {'*', "\\*"}, {'_', "\\_"}});
}

/// Escapes LaTeX's special characters.
std::string for_latex(std::string_view text) {
  return replaced(text, {{'\\', "\\textbackslash{}"},
                         {'&', "\\&"},
                         {'%', "\\%"},
                         {'$', "\\$"},
                         {'#', "\\#"},
                         {'_', "\\_"},
                         {'{', "\\{"},
                         {'}', "\\}"},
                         {'~', "\\textasciitilde{}"},
                         {'^', "\\textasciicircum{}"},
                         {'\n', " "}});
}

/// Returns the number of code points. It equals the width on a terminal, except for East Asian
/// letters.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Returns the titles of the columns, then the cells of each row, as text for readers.
std::vector<std::vector<std::string>> texts_of(const Table& table) {
  std::vector<std::vector<std::string>> lines(1);
  for (const TableColumn& column : table.columns) lines[0].push_back(column.title);
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) {
      lines.back().push_back(cell_text(row[c], table.columns[c]));
    }
  }
  return lines;
}

/// Returns the table as text in aligned columns; numbers are right-aligned. The widths of all
/// columns are computed first, then the lines.
std::string text_of(const Table& table) {
  const std::vector<bool> right = numeric_columns(table);
  const auto lines = texts_of(table);
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c)
      widths[c] = std::max(widths[c], width_of(line[c]));
  }
  std::string out = table.caption.empty() ? "" : table.caption + "\n";
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string room(widths[c] - width_of(line[c]), ' ');
      text += (c == 0 ? "" : "  ") + (right[c] ? room + line[c] : line[c] + room);
    }
    // Lines have no trailing spaces, so that the text can be kept under version control.
    out += text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  }
  return out;
}

/// Returns the table in Markdown.
std::string markdown_of(const Table& table) {
  std::string out = table.caption.empty() ? "" : for_markdown(table.caption) + "\n\n";
  const auto lines = texts_of(table);
  for (const auto& line : lines) {
    out += "|";
    for (const std::string& cell : line) out += " " + for_markdown(cell) + " |";
    out += "\n";
    if (&line != &lines.front()) continue;
    out += "|";
    for (const bool right : numeric_columns(table)) out += right ? " ---: |" : " --- |";
    out += "\n";
  }
  return out;
}

/// Returns the table in LaTeX. A line separates the row of sums. The text is a complete table
/// environment that needs no package.
std::string latex_of(const Table& table) {
  std::string places;
  for (const bool right : numeric_columns(table)) places += right ? 'r' : 'l';
  std::string out = "\\begin{table}\n\\centering\n";
  if (!table.caption.empty()) out += "\\caption{" + for_latex(table.caption) + "}\n";
  out += "\\begin{tabular}{" + places + "}\n\\hline\n";
  auto lines = texts_of(table);
  for (std::size_t r = 0; r < lines.size(); ++r) {
    for (std::string& cell : lines[r]) cell = for_latex(cell);
    if (table.has_sum && r > 0 && r + 1 == lines.size()) out += "\\hline\n";
    out += fmt::format("{} \\\\\n{}", fmt::join(lines[r], " & "), r == 0 ? "\\hline\n" : "");
  }
  return out + "\\hline\n\\end{tabular}\n\\end{table}\n";
}

/// Returns a CSV cell by RFC 4180: a cell with a comma, a quote or a line end is quoted, and quotes
/// in it are doubled.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return "\"" + replaced(text, {{'"', "\"\""}}) + "\"";
}

/// Returns the table as CSV: keys in the first line, numbers with all digits.
std::string csv_of(const Table& table) {
  std::string out;
  for (const TableColumn& column : table.columns) {
    out += (out.empty() ? "" : ",") + csv_cell(column.key);
  }
  for (const auto& row : table.rows) {
    out += "\n";
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) out += ",";
      // An unknown value gives an empty cell.
      if (const auto* text = std::get_if<std::string>(&row[c])) out += csv_cell(*text);
      if (const auto* whole = std::get_if<std::int64_t>(&row[c])) out += fmt::format("{}", *whole);
      if (const auto* number = std::get_if<double>(&row[c])) out += fmt::format("{}", *number);
    }
  }
  return out + "\n";
}

/// Returns the table as JSON. An unknown value is null.
std::string json_of(const Table& table) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t c = 0; c < row.size(); ++c) {
      auto& value = object[table.columns[c].key];
      if (const auto* text = std::get_if<std::string>(&row[c])) value = *text;
      if (const auto* whole = std::get_if<std::int64_t>(&row[c])) value = *whole;
      if (const auto* number = std::get_if<double>(&row[c])) value = *number;
    }
    rows.push_back(std::move(object));
  }
  // Bytes that are not UTF-8 are replaced.
  return rows.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::optional<TableFormat> table_format(std::string_view name) {
  for (const auto& [known, format] : formats) {
    if (known == name) return format;
  }
  return std::nullopt;
}

std::string cell_text(const Cell& cell, const TableColumn& column) {
  if (const auto* whole = std::get_if<std::int64_t>(&cell))
    return grouped(fmt::format("{}", *whole));
  if (const auto* number = std::get_if<double>(&cell)) {
    return grouped(fmt::format("{:.{}f}", *number, column.decimals));
  }
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return "–";
}

// An unknown value may be in any column, so a column with only unknown values counts as text.
std::vector<bool> numeric_columns(const Table& table) {
  std::vector<bool> out;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    bool any = false, text = false;
    for (const auto& row : table.rows) {
      text = text || std::holds_alternative<std::string>(row[c]);
      any = any || !std::holds_alternative<std::monostate>(row[c]);
    }
    out.push_back(any && !text);
  }
  return out;
}

std::string written(const Table& table, TableFormat format) {
  switch (format) {
    case TableFormat::text:
      return text_of(table);
    case TableFormat::markdown:
      return markdown_of(table);
    case TableFormat::latex:
      return latex_of(table);
    case TableFormat::csv:
      return csv_of(table);
    case TableFormat::json:
      break;
  }
  return json_of(table);
}

}  // namespace kinalign
