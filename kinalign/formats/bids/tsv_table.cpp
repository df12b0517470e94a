// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/tsv_table.h"

#include <algorithm>

namespace kinalign {

namespace {

// "a\t\tb" has three cells, of which one is empty.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> out;
  for (;;) {
    const auto tab = line.find('\t');
    out.emplace_back(line.substr(0, tab));
    if (tab == std::string_view::npos) return out;
    line.remove_prefix(tab + 1);
  }
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

TsvTable read_tsv(std::string_view text) {
  TsvTable out;
  // A byte order mark.
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  bool first = true;
  while (!text.empty()) {
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    // Lines may end in CR LF.
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (first) {
      out.columns = cells_of(line);
    } else {
      out.rows.push_back(cells_of(line));
    }
    first = false;
  }
  return out;
}

std::string tsv_cell(std::string_view text) {
  // BIDS allows no empty cells.
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
