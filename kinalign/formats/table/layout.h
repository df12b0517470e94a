// SPDX-License-Identifier: Apache-2.0
// A layout describes what the columns of a table mean. A format that only has other columns then
// needs no new code. For users: docs/formats/layouts.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/axes.h"
#include "kinalign/formats/cells.h"
#include "kinalign/formats/row_stamps.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The kind determines the fields of a layout and the reader.
enum class TableKind { points, imu };

/// The meaning of a column of a joint or node.
enum class TableField { x, y, z, state, qw, qx, qy, qz, ax, ay, az, gx, gy, gz, skip };

/// A column, given by its name. If the name is empty, the column is given by its number, counted
/// from 1.
struct ColumnChoice {
  std::string name;
  std::size_t number = 0;
};

/// The time column. `scale` gives the unit and the zero of its numbers.
struct TableTime {
  ColumnChoice column;
  TimeScale scale;
};

/// A field, and the pattern of its columns' names with the placeholder {joint} or {node}. For
/// example, "{joint}_x" gives the column Head_x for the joint Head. The pattern is empty if the
/// columns have no names.
struct FieldColumn {
  TableField field = TableField::skip;
  std::string pattern;
};

/// The numbers in the file for each tracking state. A number that is in none of the lists is an
/// error, because its meaning is unknown.
struct StateValues {
  std::vector<double> missing{0}, inferred{1}, tracked{2};
};

/// The defaults are described in docs/formats/layouts.md. parse_layout() returns only consistent
/// layouts, so readers need not check them.
struct TableLayout {
  std::string name;
  TableKind kind = TableKind::points;

  char delimiter = ',';        // a character, or the constant runs_of_blanks
  std::string comment;         // lines that begin with this text are skipped; empty: no comments
  std::size_t skip_lines = 0;  // number of first lines to skip, including comments
  bool header = true;          // the next line contains the names of the columns
  std::size_t columns = 0;     // number of cells in a row if the columns have no names

  std::optional<TableTime> time;  // empty: the rows have the rate rate_hz
  double rate_hz = 0.0;           // nominal rate; 0: unknown

  std::vector<std::string> names;   // joints or nodes; empty only for imu: a single node
  std::vector<FieldColumn> fields;  // fields of each joint or node
  /// True: columns are found by their names. False: they follow each other from first_column on.
  bool by_name = true;
  std::size_t first_column = 1;  // counted from 1

  Axes axes = y_up;              // from the file's axes; for imu: of the world, not of the sensors
  double metres_per_unit = 1.0;  // metres per unit of the file, for points
  StateValues state;
  /// [3] the position x, y, z that the file has for joints that were not seen; empty: no such
  /// position.
  std::vector<double> missing_point;

  double acceleration_unit = 1.0;      // m/s2 per unit of the file
  double angular_velocity_unit = 1.0;  // rad/s per unit of the file
  bool gravity = true;                 // true: the acceleration contains gravity

  std::map<std::string, std::string> select;  // rows to read: column -> value in this column
  std::string body;                           // column with the body's number; empty: one body
};

/// Reads a layout file of a user or of the program. `name` appears in messages. Fails at the first
/// unknown key or value.
Result<TableLayout> parse_layout(std::string_view toml, std::string_view name);

/// The layouts that are part of the program (layouts/*.toml).
std::optional<std::string_view> builtin_layout(std::string_view name);
std::vector<std::string_view> builtin_layout_names();

}  // namespace kinalign
