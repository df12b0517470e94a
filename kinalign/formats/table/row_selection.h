// SPDX-License-Identifier: Apache-2.0
// Which rows of a table are taken, and what is to be said of a choice that was wrong or not made.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Rows whose cell says `value` are taken; numbers are compared as numbers.
struct RowChoice {
  std::string column;    // as the file names it, or its number
  std::size_t text = 0;  // of RowParser::texts
  std::string value;
};

/// Texts of one column that were seen: the first few that differ.
class SeenValues {
 public:
  void see(std::string_view value);
  std::size_t count() const { return values_.size(); }
  const std::string& first() const { return values_.front(); }
  std::string list() const;  // "0, 1"

 private:
  static constexpr std::size_t most = 8;
  std::vector<std::string> values_;
  bool more_ = false;
};

class RowSelection {
 public:
  RowSelection() = default;
  /// `body` is the choice of the column that tells bodies apart, whatever its value; none where its
  /// column is empty.
  RowSelection(std::vector<RowChoice> choices, RowChoice body);

  /// Whether all choices hold for a row, of which `texts` are RowParser's.
  bool takes(const std::vector<std::string_view>& texts);

  /// After the last row: a selection that took nothing, bodies that nobody took apart.
  void report(const std::string& file, Findings& findings) const;

 private:
  std::vector<RowChoice> choices_;
  RowChoice body_;
  std::vector<SeenValues> seen_;  // of the choices' columns, until a row is taken
  SeenValues bodies_;             // of the rows taken
  std::uint64_t rows_ = 0, taken_ = 0;
};

}  // namespace kinalign
