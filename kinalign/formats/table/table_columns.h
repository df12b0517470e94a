// SPDX-License-Identifier: Apache-2.0
// Finds the columns of each quantity, from a layout and the file's column names.
#pragma once

#include "kinalign/formats/table/layout.h"
#include "kinalign/formats/table/row_selection.h"
#include "kinalign/motion/streams.h"

#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The result of the search. RowParser stores numbers in slots and texts in places of its arrays.
/// The slots of each quantity are consecutive.
struct TableColumns {
  std::vector<ColumnUse> uses;  // [columns] what to do with each column
  std::vector<RowChoice> choices;
  RowChoice body;      // the column with the number of the body; empty name: none
  int time_text = -1;  // index of the time in RowParser::texts; -1: no time column

  // The first slot of each quantity in RowParser::values, for M joints or nodes; -1: not in the
  // file.
  int positions = -1;                                              // [M,3] x, y, z of each joint
  int states = -1;                                                 // [M] tracking states
  int orientation = -1, acceleration = -1, angular_velocity = -1;  // [M,4], [M,3], [M,3]
  std::vector<std::string> absent;  // one column name of each quantity that the file lacks
  std::size_t unread = 0;           // number of columns that are not used
};

/// `members`: the joints or nodes. `names`: the file's column names; empty if the file has none.
/// States and inertial quantities are left out if all their columns are absent. Fails if another
/// column is missing or occurs twice. The caller adds file and line to the error.
Result<TableColumns> find_columns(const TableLayout& layout,
                                  const std::vector<std::string>& members,
                                  const std::map<std::string, std::string>& select,
                                  const std::vector<std::string>& names);

}  // namespace kinalign
