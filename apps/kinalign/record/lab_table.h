// SPDX-License-Identifier: Apache-2.0
// The table about a lab that `record` shows on a terminal. Pure functions.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// A line of the table. `bad`: something required is missing, or something was lost.
/// Layout is finished; the printer only adds colours.
struct TableLine {
  std::string text;
  bool bad = false;
  bool head = false;
};

/// The table: a head if there are columns besides the device, and a line for each sender, each
/// device that has sent nothing, and each port that lost data. Columns without a value are left
/// out; then columns from the right until the lines fit into `width` columns of the terminal. Lines
/// that are still wider stay so.
std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status, std::size_t width);

/// The table in `rows` lines. If there are more, bad lines come first, and the last line states the
/// number of the others.
/// The table must not be longer than the terminal, since lines that scroll away can't be erased.
std::vector<TableLine> fitted(std::vector<TableLine> table, std::size_t rows);

}  // namespace kinalign
