// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/cells.h"

#include "kinalign/core/numbers.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

std::string_view unquoted(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
  return trimmed(cell.substr(1, cell.size() - 2));
}

/// The text from one pointer to another.
std::string_view between(const char* at, const char* end) {
  return {at, static_cast<std::size_t>(end - at)};
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

bool says_missing(std::string_view cell) {
  if (cell.empty()) return true;
  // Some programs write "-nan".
  if (cell.starts_with('-')) cell.remove_prefix(1);
  return cell.size() == 3 && (cell[0] | 32) == 'n' && (cell[1] | 32) == 'a' &&
         (cell[2] | 32) == 'n';
}

RowParser::RowParser(char delimiter, std::vector<ColumnUse> columns)
    : delimiter_(delimiter), columns_(std::move(columns)) {
  int slots = 0;
  int wanted_texts = 0;
  // The highest slot and text index determine the sizes of the arrays.
  for (const ColumnUse use : columns_) {
    slots = std::max(slots, use.slot + 1);
    wanted_texts = std::max(wanted_texts, use.text + 1);
  }
  values.resize(static_cast<std::size_t>(slots));
  missing.resize(static_cast<std::size_t>(slots));
  texts.resize(static_cast<std::size_t>(wanted_texts));
}

inline bool RowParser::delimits(char c) const {
  return delimiter_ == runs_of_blanks ? c == ' ' || c == '\t' : c == delimiter_;
}

inline bool RowParser::pads(char c) const { return (c == ' ' || c == '\t') && c != delimiter_; }

/// The end of the cell at `at`: the next delimiter that is not between double quotes.
const char* RowParser::cell_end(const char* at, const char* end) const {
  if (at != end && *at == '"') {
    const char* closing = std::find(at + 1, end, '"');
    if (closing != end) at = closing;
  }
  return std::find_if(at, end, [this](char c) { return delimits(c); });
}

/// Handles the rare cells for number(): a cell in quotes, a missing value, or a fault. Returns the
/// end of the cell, or nullptr if the cell is neither a number below `largest_number` nor missing.
const char* RowParser::odd_number(const char* at, const char* end, int slot) {
  const auto i = static_cast<std::size_t>(slot);
  // In a cell in quotes, delimiters before the closing quote do not count.
  const char* behind = cell_end(at, end);
  const std::string_view cell = unquoted(trimmed(between(at, behind)));
  // A missing value becomes 0, so that it does not keep the value of the previous row.
  values[i] = 0.0;
  if (says_missing(cell)) {
    missing[i] = 1;
    any_missing = true;
    return behind;
  }
  if (!parse_number(cell, values[i]) || !(std::abs(values[i]) < largest_number)) return nullptr;
  return behind;
}

/// Handles the frequent case: a plain number directly in front of a delimiter. odd_number() handles
/// all other cells. Returns the end of the cell, or nullptr on a fault.
inline const char* RowParser::number(const char* at, const char* end, int slot) {
  double& value = values[static_cast<std::size_t>(slot)];
  const char* behind = parse_number(at, end, value);
  if (behind == nullptr || !(std::abs(value) < largest_number)) return odd_number(at, end, slot);
  // A delimiter must follow directly; otherwise odd_number() handles the cell.
  if (behind == end || *behind == delimiter_) return behind;
  if (delimiter_ == runs_of_blanks && delimits(*behind)) return behind;
  return odd_number(at, end, slot);
}

inline const char* RowParser::read_cell(ColumnUse use, const char* at, const char* end) {
  const char* behind = use.slot >= 0 ? number(at, end, use.slot) : cell_end(at, end);
  if (use.text >= 0 && behind != nullptr) {
    texts[static_cast<std::size_t>(use.text)] = unquoted(trimmed(between(at, behind)));
  }
  return behind;
}

/// Reads all columns of a row. `runs`: any number of blanks is a delimiter. This is a template
/// parameter, so that the loop over the cells does not test it.
template <bool runs>
Result<void> RowParser::read_cells(const char* at, const char* end) {
  const std::size_t last = columns_.size() - 1;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    while (at != end && pads(*at)) ++at;
    // The line has too few cells. With runs of blanks as delimiters, there is no empty last cell.
    if (runs && at == end) return wrong_count(i);
    const char* behind = read_cell(columns_[i], at, end);
    if (behind == nullptr) return no_number(i, between(at, cell_end(at, end)));
    if (!runs && behind == end && i < last) return wrong_count(i + 1);
    at = !runs && behind != end ? behind + 1 : behind;  // moves behind the delimiter
  }
  return nothing_behind(at, end);
}

/// Delimiters at the end of a line are accepted. A further cell is an error.
Result<void> RowParser::nothing_behind(const char* at, const char* end) const {
  if (std::all_of(at, end, [this](char c) { return pads(c) || delimits(c); })) return {};
  return wrong_count(columns_.size() + split_cells(between(at, end), delimiter_).size());
}

Result<void> RowParser::read(std::string_view line) {
  // The flags are cleared only if needed, because most rows have no missing values.
  if (any_missing) {
    std::fill(missing.begin(), missing.end(), std::uint8_t{0});
    any_missing = false;
  }
  const char* end = line.data() + line.size();
  return delimiter_ == runs_of_blanks ? read_cells<true>(line.data(), end)
                                      : read_cells<false>(line.data(), end);
}

Failure RowParser::no_number(std::size_t column, std::string_view cell) {
  return refuse("a number in column " + std::to_string(column + 1), shown(trimmed(cell)));
}

Failure RowParser::wrong_count(std::size_t cells) const {
  return refuse(std::to_string(columns_.size()) + " cells", std::to_string(cells));
}

std::vector<std::string> split_cells(std::string_view line, char delimiter) {
  std::vector<std::string> cells;
  // If runs of blanks are the delimiters, no cell is empty.
  if (delimiter == runs_of_blanks) {
    for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
      const auto length = std::min(line.find_first_of(" \t"), line.size());
      cells.emplace_back(unquoted(line.substr(0, length)));
      line.remove_prefix(length);
    }
    return cells;
  }
  for (;;) {
    const auto length = line.find(delimiter);
    cells.emplace_back(unquoted(trimmed(line.substr(0, length))));
    if (length == std::string_view::npos) break;
    line.remove_prefix(length + 1);
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();  // delimiters at the line's end
  return cells;
}

bool fits_a_cell(std::string_view name) {
  return !name.empty() && name.find_first_of("\t\r\n") == std::string_view::npos;
}

}  // namespace kinalign
