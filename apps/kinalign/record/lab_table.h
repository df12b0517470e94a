// SPDX-License-Identifier: Apache-2.0
// The table that `record` shows of a lab on a terminal. Pure.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// A line of the table; `bad` lines are of what is missing and required, and of what is lost.
struct TableLine {
  std::string text;
  bool bad = false;
  bool head = false;
};

/// Head, where there is a column but the device's, and a line for each sender, each device of which
/// nothing comes, and each port where something was lost before it could be recorded. Columns that
/// nobody has anything for are left out, and of the others as many as do not fit into `width`
/// places; what else is wider stays so.
std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status, std::size_t width);

/// As much of a table as has room in so many rows: from below good lines are left out first, then
/// bad ones, the head last; the last row then says how many.
std::vector<TableLine> fitted(std::vector<TableLine> table, std::size_t rows);

}  // namespace kinalign
