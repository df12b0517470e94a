// SPDX-License-Identifier: Apache-2.0
// Makes the table about a lab that `record` shows on a terminal.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// A finished line of the table, to which the printer only adds colours. `bad`: a required sender
/// is missing, or data was lost.
struct TableLine {
  std::string text;
  bool bad = false;
  bool head = false;
};

/// Makes the table: a line for each sender, each device that has sent nothing, and each port that
/// lost data. If there are columns besides the device, a line with their heads comes first. Columns
/// without a value are left out. If lines are wider than `width` columns of the terminal, the
/// rightmost columns are left out, too. A line may still be wider after that.
std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status, std::size_t width);

/// Shortens the table to `rows` lines: lines with faults come first, and the last line states the
/// number of hidden lines. A table longer than the terminal would scroll and could not be erased.
std::vector<TableLine> fitted(std::vector<TableLine> table, std::size_t rows);

}  // namespace kinalign
