// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/imu/xsens_columns.h"

#include <algorithm>
#include <numbers>

namespace kinalign {

namespace {

class Finder {
 public:
  explicit Finder(const std::vector<std::string>& names) : names_(names), uses_(names.size()) {}

  XsensGroup find(const std::vector<std::string_view>& wanted) {
    std::vector<std::size_t> columns;
    for (const std::string_view name : wanted) {
      const auto at = std::find(names_.begin(), names_.end(), name);
      if (at == names_.end()) return {};
      columns.push_back(static_cast<std::size_t>(at - names_.begin()));
    }
    XsensGroup group;
    for (const std::size_t column : columns) {
      if (uses_[column].slot < 0) uses_[column].slot = slots_++;
      group.slots.push_back(static_cast<std::size_t>(uses_[column].slot));
    }
    return group;
  }

  std::vector<ColumnUse> uses() const { return uses_; }

 private:
  const std::vector<std::string>& names_;
  std::vector<ColumnUse> uses_;
  int slots_ = 0;
};

double value(const XsensGroup& group, const RowParser& row, std::size_t i) {
  return row.values[group.slots[i]];
}

}  // namespace

bool XsensGroup::any(const RowParser& row) const {
  return std::any_of(slots.begin(), slots.end(),
                     [&](std::size_t i) { return row.missing[i] == 0; });
}

bool XsensGroup::whole(const RowParser& row) const {
  return there() && std::all_of(slots.begin(), slots.end(),
                                [&](std::size_t i) { return row.missing[i] == 0; });
}

std::optional<char> xsens_delimiter(std::string_view names) {
  for (const char delimiter : {'\t', ',', ';', '|', ':', ' '}) {
    if (names.find(delimiter) != std::string_view::npos) return delimiter;
  }
  return std::nullopt;
}

XsensColumns find_xsens_columns(const std::vector<std::string>& names) {
  Finder finder(names);
  XsensColumns columns;
  columns.counter = finder.find({"PacketCounter"});
  columns.quaternion = finder.find({"Quat_q0", "Quat_q1", "Quat_q2", "Quat_q3"});
  columns.matrix = finder.find({"Mat[1][1]", "Mat[1][2]", "Mat[1][3]", "Mat[2][1]", "Mat[2][2]",
                                "Mat[2][3]", "Mat[3][1]", "Mat[3][2]", "Mat[3][3]"});
  columns.euler = finder.find({"Roll", "Pitch", "Yaw"});
  columns.acceleration = finder.find({"Acc_X", "Acc_Y", "Acc_Z"});
  columns.free_acceleration = finder.find({"FreeAcc_X", "FreeAcc_Y", "FreeAcc_Z"});
  if (!columns.free_acceleration.there()) {
    columns.free_acceleration = finder.find({"FreeAcc_E", "FreeAcc_N", "FreeAcc_U"});
  }
  columns.angular_velocity = finder.find({"Gyr_X", "Gyr_Y", "Gyr_Z"});
  columns.uses = finder.uses();
  return columns;
}

Quat xsens_quaternion(const XsensGroup& group, const RowParser& row) {
  return {value(group, row, 0), value(group, row, 1), value(group, row, 2), value(group, row, 3)};
}

Quat xsens_from_matrix(const XsensGroup& group, const RowParser& row) {
  Eigen::Matrix3d matrix;
  for (Eigen::Index i = 0; i < 9; ++i) {
    matrix(i / 3, i % 3) = value(group, row, static_cast<std::size_t>(i));
  }
  return Quat(matrix);
}

Quat xsens_from_euler(const XsensGroup& group, const RowParser& row) {
  constexpr double degree = std::numbers::pi / 180.0;
  const Eigen::AngleAxisd roll(value(group, row, 0) * degree, Vec3::UnitX());
  const Eigen::AngleAxisd pitch(value(group, row, 1) * degree, Vec3::UnitY());
  const Eigen::AngleAxisd yaw(value(group, row, 2) * degree, Vec3::UnitZ());
  return yaw * pitch * roll;
}

}  // namespace kinalign
