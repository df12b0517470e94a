// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/tsv_table.h"

#include "kinalign/core/utf8.h"

#include <algorithm>

namespace kinalign {

namespace {

std::vector<std::string> cells_of(std::string_view line) {
  // Lines may end with CR LF.
  if (line.ends_with('\r')) line.remove_suffix(1);
  const auto cells = split(line, '\t');
  return {cells.begin(), cells.end()};
}

void put_row(const std::vector<std::string>& cells, std::string& out) {
  for (std::size_t i = 0; i < cells.size(); ++i) out += (i > 0 ? "\t" : "") + tsv_cell(cells[i]);
  out += '\n';
}

}  // namespace

std::optional<std::size_t> TsvTable::column(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

std::vector<std::string_view> split(std::string_view text, char delimiter) {
  std::vector<std::string_view> out;
  for (;;) {
    const auto end = text.find(delimiter);
    out.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return out;
    text.remove_prefix(end + 1);
  }
}

TsvTable read_tsv(std::string_view text) {
  TsvTable out;
  text = without_byte_order_mark(text);
  if (text.ends_with('\n')) text.remove_suffix(1);
  if (text.empty()) return out;
  for (const std::string_view line : split(text, '\n')) out.rows.push_back(cells_of(line));
  out.columns = std::move(out.rows.front());
  out.rows.erase(out.rows.begin());
  return out;
}

std::string tsv_cell(std::string_view text) {
  // BIDS does not allow empty cells.
  if (text.empty()) return "n/a";
  std::string out(text);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return out;
}

std::string write_tsv(const TsvTable& table) {
  std::string out;
  put_row(table.columns, out);
  for (const auto& row : table.rows) put_row(row, out);
  return out;
}

}  // namespace kinalign
