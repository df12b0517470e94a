// SPDX-License-Identifier: Apache-2.0
// A declared layout: it tells what the columns of a table mean. A format that differs only in its
// columns then needs no program. For users: docs/formats/layouts.md.
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

/// The kind decides which fields a layout may have and which reader is made.
enum class TableKind { points, imu };

/// The meaning of a column of a joint or node.
enum class TableField { x, y, z, state, qw, qx, qy, qz, ax, ay, az, gx, gy, gz, skip };

/// A column, given by its name or, if the name is empty, by its number from 1.
struct ColumnChoice {
  std::string name;
  std::size_t number = 0;
};

/// The column holds a number; the scale tells what it counts and from when.
struct TableTime {
  ColumnChoice column;
  TimeScale scale;
};

/// A field and its column's name with the placeholder {joint} or {node}. The pattern is empty if
/// the columns have no names.
/// "{joint}_x" is the column Head_x of the joint Head.
struct FieldColumn {
  TableField field = TableField::skip;
  std::string pattern;
};

/// The numbers that stand for each tracking state.
/// A number that is in none of the lists is an error, because it could mean anything.
struct StateValues {
  std::vector<double> missing{0}, inferred{1}, tracked{2};
};

/// The defaults are those of docs/formats/layouts.md. A layout from parse_layout() is consistent,
/// so readers need not check it.
struct TableLayout {
  std::string name;
  TableKind kind = TableKind::points;

  char delimiter = ',';        // a character, or runs_of_blanks
  std::string comment;         // lines that begin with this text are skipped; empty: none
  std::size_t skip_lines = 0;  // lines to skip at the front, comments included
  bool header = true;          // the next line holds the names of the columns
  std::size_t columns = 0;     // cells of a row, if the columns have no names

  std::optional<TableTime> time;  // absent: rows come at rate_hz
  double rate_hz = 0.0;           // nominal; 0: unknown

  std::vector<std::string> names;   // joints or nodes; imu: may be empty (one node)
  std::vector<FieldColumn> fields;  // the same for each joint or node
  /// Columns are found by patterns; else they follow in order from first_column.
  bool by_name = true;
  std::size_t first_column = 1;  // counted from 1

  Axes axes = y_up;              // ours from the file's; imu: of the world, not of the sensors
  double metres_per_unit = 1.0;  // for points
  StateValues state;
  /// [3] x, y, z in the file of a joint that was not seen; empty: none.
  std::vector<double> missing_point;

  double acceleration_unit = 1.0;      // m/s2 per unit of the file
  double angular_velocity_unit = 1.0;  // rad/s per unit of the file
  bool gravity = true;                 // true: gravity is part of the acceleration

  std::map<std::string, std::string> select;  // rows to read: column -> value
  std::string body;                           // column with the number of the body; empty: one body
};

/// Reads a layout file. `name` appears in messages. Fails at the first unknown key or value.
/// Called for the layouts of the program and for files of users alike.
Result<TableLayout> parse_layout(std::string_view toml, std::string_view name);

/// The layouts that are part of the program (layouts/*.toml).
std::optional<std::string_view> builtin_layout(std::string_view name);
std::vector<std::string_view> builtin_layout_names();

}  // namespace kinalign
