// SPDX-License-Identifier: Apache-2.0
// Selects the rows of a table. Adds findings if no row fits, or if a selection is needed but
// absent.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A condition: the cell in `column` must equal `value`. Cells are compared as texts, then as
/// numbers.
struct RowChoice {
  std::string column;    // name or number of the column in the file
  std::size_t text = 0;  // index of the column's text in RowParser::texts
  std::string value;
};

/// The first few different texts of one column. A message shows them to a user whose selection fits
/// no row.
class SeenValues {
 public:
  void see(std::string_view value);
  std::size_t count() const { return values_.size(); }
  const std::string& first() const { return values_.front(); }
  std::string list() const;  // for example "0, 1"

 private:
  static constexpr std::size_t most = 8;
  std::vector<std::string> values_;
  bool more_ = false;
};

/// Selects rows. A row is selected before it is converted, so rows of other bodies may contain
/// anything.
class RowSelection {
 public:
  RowSelection() = default;
  /// `body.column` is the column with the number of the body; empty if there is none. `body.value`
  /// is not used.
  RowSelection(std::vector<RowChoice> choices, RowChoice body);

  /// True if the row fulfils all conditions. `texts` come from RowParser.
  bool takes(const std::vector<std::string_view>& texts);

  /// Call this after the last row. Adds a finding if no row fits the selection, or if rows of
  /// several bodies were read as one body.
  void report(const std::string& file, Findings& findings) const;

 private:
  std::vector<RowChoice> choices_;
  RowChoice body_;
  // seen_ is filled only until a row was selected, because no message needs it afterwards.
  std::vector<SeenValues> seen_;  // values in the columns of the conditions
  SeenValues bodies_;             // bodies of the selected rows
  std::uint64_t rows_ = 0, taken_ = 0;
};

}  // namespace kinalign
