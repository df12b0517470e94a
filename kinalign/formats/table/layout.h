// SPDX-License-Identifier: Apache-2.0
// A declared layout: what the columns of a table mean, so that a format that is only a matter of
// columns needs no program. For users: docs/formats/layouts.md.
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

enum class TableKind { points, imu };

/// What a column of a joint or node holds.
enum class TableField { x, y, z, state, qw, qx, qy, qz, ax, ay, az, gx, gy, gz, skip };

/// A column by its name, or by its number from 1 where the name is empty.
struct ColumnChoice {
  std::string name;
  std::size_t number = 0;
};

struct TableTime {
  ColumnChoice column;
  TimeScale scale;
};

/// A field and, where the columns have names, its column's with {joint} or {node} in it.
struct FieldColumn {
  TableField field = TableField::skip;
  std::string pattern;
};

struct StateValues {
  std::vector<double> missing{0}, inferred{1}, tracked{2};
};

struct TableLayout {
  std::string name;
  TableKind kind = TableKind::points;

  char delimiter = ',';        // or runs_of_blanks
  std::string comment;         // lines that begin so are skipped; empty: there are none
  std::size_t skip_lines = 0;  // at the front, comments counted
  bool header = true;          // then a line of column names
  std::size_t columns = 0;     // cells of a row, where no names say it

  std::optional<TableTime> time;  // absent: rows come at rate_hz
  double rate_hz = 0.0;           // nominal; 0: unknown

  std::vector<std::string> names;   // of joints or nodes; imu: may be empty (one node)
  std::vector<FieldColumn> fields;  // per joint or node
  bool by_name = true;              // by patterns; else in order from first_column on
  std::size_t first_column = 1;     // from 1

  Axes axes = y_up;              // imu: of the world, not of the sensors
  double metres_per_unit = 1.0;  // points
  StateValues state;
  std::vector<double> missing_point;  // [3] the file's x, y, z of an unseen joint; empty: none

  double acceleration_unit = 1.0;      // m/s2
  double angular_velocity_unit = 1.0;  // rad/s
  bool gravity = true;                 // stands in the acceleration

  std::map<std::string, std::string> select;  // rows to take: column -> value
  std::string body;  // the column that tells several bodies apart; empty: there is one body
};

/// `name` appears in messages. Fails at the first key or value that is not understood.
Result<TableLayout> parse_layout(std::string_view toml, std::string_view name);

/// The layouts that the program carries (layouts/*.toml).
std::optional<std::string_view> builtin_layout(std::string_view name);
std::vector<std::string_view> builtin_layout_names();

}  // namespace kinalign
