// SPDX-License-Identifier: Apache-2.0
// Decides which rows of a table are read, and reports a selection that fits no row or is missing.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A condition: the cell of `column` must equal `value`. Numbers are compared as numbers.
/// Cells are compared as texts first, which is exact for names.
struct RowChoice {
  std::string column;    // name or number of the column in the file
  std::size_t text = 0;  // index in RowParser::texts
  std::string value;
};

/// The first few different texts of one column, for messages.
/// They show a user what a selection could have named.
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

/// The selection is made before a row is converted, so rows of other bodies may hold anything.
class RowSelection {
 public:
  RowSelection() = default;
  /// `body.column` is the column with the number of the body; empty: there is none. `body.value` is
  /// not used.
  RowSelection(std::vector<RowChoice> choices, RowChoice body);

  /// True if the row meets all choices. `texts` are those of RowParser.
  bool takes(const std::vector<std::string_view>& texts);

  /// Call after the last row. Reports a selection that fits no row, and rows of several bodies that
  /// were read as one.
  void report(const std::string& file, Findings& findings) const;

 private:
  std::vector<RowChoice> choices_;
  RowChoice body_;
  // seen_ is filled only until a row is taken: afterwards no message needs it.
  std::vector<SeenValues> seen_;  // values of the choices' columns, until a row is taken
  SeenValues bodies_;             // bodies in the rows taken
  std::uint64_t rows_ = 0, taken_ = 0;
};

}  // namespace kinalign
