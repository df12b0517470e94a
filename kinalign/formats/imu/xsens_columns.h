// SPDX-License-Identifier: Apache-2.0
// What the named columns of an Xsens text export hold and how an orientation is made of them.
#pragma once

#include "kinalign/formats/cells.h"
#include "kinalign/motion/arrays.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A group of columns of RowParser::values; empty: not all of them are in the file.
struct XsensGroup {
  std::vector<std::size_t> slots;

  bool there() const { return !slots.empty(); }
  bool any(const RowParser& row) const;
  bool whole(const RowParser& row) const;
};

struct XsensColumns {
  std::vector<ColumnUse> uses;
  XsensGroup counter, quaternion, matrix, euler, acceleration, free_acceleration, angular_velocity;
};

/// The delimiter of a line of names: tab, comma, semicolon, bar, colon or blank.
std::optional<char> xsens_delimiter(std::string_view names);

XsensColumns find_xsens_columns(const std::vector<std::string>& names);

/// world_from_sensor, world z up, w,x,y,z of any length. The group must be whole in the row.
Quat xsens_quaternion(const XsensGroup& group, const RowParser& row);
Quat xsens_from_matrix(const XsensGroup& group, const RowParser& row);  // Mat[row][column]
Quat xsens_from_euler(const XsensGroup& group, const RowParser& row);   // R = Rz Ry Rx, degrees

}  // namespace kinalign
