// SPDX-License-Identifier: Apache-2.0
// The table about a lab that `record` shows on a terminal. Pure functions.
#pragma once

#include "apps/kinalign/text/record_text.h"

#include <cstddef>
#include <string>
#include <vector>

namespace kinalign {

/// A line of the table. `bad`: something required is missing, or something was lost.
struct TableLine {
  std::string text;
  bool bad = false;
  bool head = false;
};

/// The table: a head if there are columns besides the device, and a line for each sender, each
/// device that has sent nothing, and each port that lost data. Columns without a value are left
/// out; then less important ones until the lines fit into `width` columns of the terminal. Lines
/// that are still wider stay so.
std::vector<TableLine> lab_table(const Lab& lab, const LabStatus& status, std::size_t width);

/// The table cut to `rows` lines. Good lines are left out first, from the bottom, then bad ones,
/// the head last. The last line then states their number.
std::vector<TableLine> fitted(std::vector<TableLine> table, std::size_t rows);

}  // namespace kinalign
