// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace kinalign {

namespace {

// The types in BIDS 1.9.
constexpr std::array<std::string_view, 10> bids_types{
    "ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY", "MAGN", "MISC", "ORNT", "POS", "VEL"};
constexpr std::array<std::string_view, 8> bids_components{"x",      "y",      "z",      "quat_x",
                                                          "quat_y", "quat_z", "quat_w", "n/a"};

// The columns of channels.tsv. The first five are required.
constexpr std::size_t required_columns = 5;
constexpr std::array<std::pair<const char*, std::string BidsChannel::*>, 7> channel_columns{
    {{"name", &BidsChannel::name},
     {"component", &BidsChannel::component},
     {"type", &BidsChannel::type},
     {"tracked_point", &BidsChannel::tracked_point},
     {"units", &BidsChannel::units},
     {"placement", &BidsChannel::placement},
     {"reference_frame", &BidsChannel::reference_frame}}};

struct Unit {
  std::string_view type, unit;
  double scale;
};
constexpr double degree = std::numbers::pi / 180.0;
// The accepted units. A type may have several units.
constexpr std::array<Unit, 17> bids_units{{{"POS", "m", 1.0},
                                           {"POS", "cm", 0.01},
                                           {"POS", "mm", 0.001},
                                           {"VEL", "m/s", 1.0},
                                           {"ACCEL", "m/s^2", 1.0},
                                           {"ACCEL", "g", 9.80665},
                                           {"GYRO", "rad/s", 1.0},
                                           {"GYRO", "deg/s", degree},
                                           {"ANGACCEL", "rad/s^2", 1.0},
                                           {"ANGACCEL", "deg/s^2", degree},
                                           {"ORNT", "rad", 1.0},
                                           {"ORNT", "deg", degree},
                                           {"ORNT", "n/a", 1.0},
                                           {"JNTANG", "rad", 1.0},
                                           {"JNTANG", "deg", degree},
                                           {"LATENCY", "s", 1.0},
                                           {"LATENCY", "seconds", 1.0}}};

/// Adds the channels of one tracked point and one type. `like` contains the fields that all
/// channels of the type have in common.
template <std::size_t n>
void add(const std::string& point, const std::array<const char*, n>& parts, const BidsChannel& like,
         std::vector<BidsChannel>& out) {
  for (const char* part : parts) {
    BidsChannel channel = like;
    channel.name = fmt::format("{}_{}_{}", point, like.type, part);
    channel.component = part;
    channel.tracked_point = point;
    channel.placement = point;
    out.push_back(std::move(channel));
  }
}

BidsChannel kind(const char* type, const char* unit, const char* frame) {
  return {"", "", type, "", unit, "", frame};
}

void add_channels(const Skeleton& skeleton, std::vector<BidsChannel>& out) {
  for (const std::string& joint : skeleton.joint_names) {
    add(joint, bids_axes, kind("POS", "m", "global"), out);
    add(joint, bids_quaternion, kind("ORNT", "n/a", "global"), out);
  }
}

void add_channels(const PointHeader& points, std::vector<BidsChannel>& out) {
  for (const std::string& point : points.joint_names) {
    add(point, bids_axes, kind("POS", "m", "global"), out);
  }
}

void add_channels(const ImuHeader& nodes, std::vector<BidsChannel>& out) {
  for (const std::string& node : nodes.node_names) {
    // Vectors of a sensor stay in its own space ("sensor"). Only orientations are global.
    if (nodes.content.orientation) add(node, bids_quaternion, kind("ORNT", "n/a", "global"), out);
    if (nodes.content.acceleration) add(node, bids_axes, kind("ACCEL", "m/s^2", "sensor"), out);
    if (nodes.content.angular_velocity) add(node, bids_axes, kind("GYRO", "rad/s", "sensor"), out);
  }
}

/// The direction of a letter in a right-handed space with x to the right, y forwards and z up. BIDS
/// names directions from the person's view: right, anterior (forwards), superior (up).
std::optional<Vec3> direction(char letter) {
  switch (letter) {
    case 'R':
      return Vec3(1, 0, 0);
    case 'L':
      return Vec3(-1, 0, 0);
    case 'A':
      return Vec3(0, 1, 0);
    case 'P':
      return Vec3(0, -1, 0);
    case 'S':
      return Vec3(0, 0, 1);
    case 'I':
      return Vec3(0, 0, -1);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::vector<BidsChannel> bids_channels(const BidsSource& source) {
  // The latency channel does not belong to a tracked point.
  std::vector<BidsChannel> out{{"latency", "n/a", "LATENCY", "n/a", "s", "n/a", "n/a"}};
  std::visit([&out](const auto& one) { add_channels(one, out); }, source);
  return out;
}

std::vector<std::pair<std::string, std::size_t>> bids_counts(
    std::span<const BidsChannel> channels) {
  std::set<std::string_view> points;
  std::map<std::string_view, std::size_t> of_type;
  for (const BidsChannel& channel : channels) {
    ++of_type[channel.type];
    if (channel.tracked_point != "n/a") points.insert(channel.tracked_point);
  }
  std::vector<std::pair<std::string, std::size_t>> out{{"MotionChannelCount", channels.size()},
                                                       {"TrackedPointsCount", points.size()}};
  for (const char* type :
       {"POS", "ORNT", "ACCEL", "GYRO", "MAGN", "VEL", "ANGACCEL", "JNTANG", "LATENCY"}) {
    out.emplace_back(std::string(type) + "ChannelCount", of_type[type]);
  }
  return out;
}

TsvTable channels_table(std::span<const BidsChannel> channels) {
  TsvTable out;
  for (const auto& [column, member] : channel_columns) out.columns.emplace_back(column);
  for (const BidsChannel& channel : channels) {
    auto& row = out.rows.emplace_back();
    for (const auto& [column, member] : channel_columns) row.push_back(channel.*member);
  }
  return out;
}

// Reads each row by the names of the columns, because the columns may have any order.
Result<std::vector<BidsChannel>> channels_of(const TsvTable& table, std::string_view file) {
  std::vector<BidsChannel> out(table.rows.size());
  for (std::size_t f = 0; f < channel_columns.size(); ++f) {
    const auto& [name, member] = channel_columns[f];
    const auto column = table.column(name);
    if (!column && f < required_columns) {
      return Failure(Error{std::string(file), 1, std::string("a column ") + name, "none"});
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      // A row may be shorter than the header line.
      const bool there = column && *column < table.rows[i].size();
      out[i].*member = there ? table.rows[i][*column] : "n/a";
    }
  }
  return out;
}

bool is_bids_type(std::string_view type) {
  return std::find(bids_types.begin(), bids_types.end(), type) != bids_types.end();
}

bool is_bids_component(std::string_view component) {
  return std::find(bids_components.begin(), bids_components.end(), component) !=
         bids_components.end();
}

double unit_scale(std::string_view type, std::string_view unit) {
  for (const Unit& known : bids_units) {
    if (known.type == type && known.unit == unit) return known.scale;
  }
  return 0.0;
}

std::optional<Axes> axes_of_letters(std::string_view letters) {
  if (letters.size() != 3) return std::nullopt;
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  // True if each letter names a direction. The handedness is then known.
  bool all = true;
  int up = 0;  // number of the axis that points up, from 1; negative: down
  for (int k = 0; k < 3; ++k) {
    const auto points_to = direction(letters[static_cast<std::size_t>(k)]);
    all = all && points_to.has_value();
    if (!points_to) continue;
    directions.col(k) = *points_to;
    if (points_to->z() != 0.0) up = points_to->z() > 0.0 ? k + 1 : -(k + 1);
  }
  // The determinant is 0 if two letters name the same axis, or if a letter names no axis.
  const double hand = directions.determinant();
  // If no letter names the up axis, the axes are not known.
  if (up == 0 || (all && hand == 0.0)) return std::nullopt;
  // For each up axis, a rotation that makes it kinalign's y. A rotation keeps the space
  // right-handed.
  constexpr std::array<Axes, 3> upwards{{{-2, 1, 3}, {1, 2, 3}, {1, 3, -2}}},
      downwards{{{2, -1, 3}, {1, -2, -3}, {1, -3, 2}}};
  const auto index = static_cast<std::size_t>(std::abs(up) - 1);
  Axes out = up > 0 ? upwards[index] : downwards[index];
  // Changing the sign of one axis makes a left-handed space right-handed.
  if (all && hand < 0.0) out[2] = -out[2];  // a left-handed space
  return out;
}

}  // namespace kinalign
