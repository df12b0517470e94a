// SPDX-License-Identifier: Apache-2.0
// Which column of a file holds what, found from a layout and the file's names of columns.
#pragma once

#include "kinalign/formats/table/layout.h"
#include "kinalign/formats/table/row_selection.h"
#include "kinalign/motion/streams.h"

#include <map>
#include <string>
#include <vector>

namespace kinalign {

struct TableColumns {
  std::vector<ColumnUse> uses;  // [columns]
  std::vector<RowChoice> choices;
  RowChoice body;      // the column that tells bodies apart; none where its name is empty
  int time_text = -1;  // of RowParser::texts; -1: there is no time column

  // Of RowParser::values, M joints or nodes; -1: not in the file.
  int positions = -1;                                              // [M,3]
  int states = -1;                                                 // [M]
  int orientation = -1, acceleration = -1, angular_velocity = -1;  // [M,4], [M,3], [M,3]
  std::vector<std::string> absent;  // a column of each quantity that was left out
  std::size_t unread = 0;           // columns of the file of which nothing is used
};

/// `members` are the joints or nodes; `names` the file's columns, empty where no line names them.
/// Quantities of an IMU and states whose columns are all absent are left out. Fails, without a
/// place, where another column is missing or stands twice.
Result<TableColumns> find_columns(const TableLayout& layout,
                                  const std::vector<std::string>& members,
                                  const std::map<std::string, std::string>& select,
                                  const std::vector<std::string>& names);

}  // namespace kinalign
