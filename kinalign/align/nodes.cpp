// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/nodes.h"

#include "kinalign/clock/time_model.h"
#include "kinalign/motion/index_of.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Copies columns of the stream's rows into the group's rows. Each node has `width` values.
template <class T>
void put_columns(const std::vector<T>& from, std::size_t width, std::size_t rows,
                 const NodeColumns& columns, std::vector<T>& to) {
  // A quantity that the stream does not have stays empty in the group.
  if (from.empty() || rows == 0) return;
  const std::size_t take = from.size() / rows;
  const std::size_t stride = columns.all * width, first = columns.first * width;
  to.resize(rows * stride);
  for (std::size_t r = 0; r < rows; ++r) {
    std::copy_n(&from[r * take], take, &to[r * stride + first]);
  }
}

}  // namespace

void put_nodes(const ImuRows& from, std::size_t rows, const NodeColumns& columns, ImuRows& to) {
  put_columns(from.orientation, 4, rows, columns, to.orientation);
  put_columns(from.acceleration, 3, rows, columns, to.acceleration);
  put_columns(from.angular_velocity, 3, rows, columns, to.angular_velocity);
  put_columns(from.valid, 1, rows, columns, to.valid);
  put_columns(from.distance.nearest_raw_ns, 1, rows, columns, to.distance.nearest_raw_ns);
  // If other nodes have intervals, nodes without intervals get no_interval.
  auto& intervals = to.distance.time_interval_ns;
  if (!from.distance.time_interval_ns.empty()) intervals.resize(rows * columns.all, no_interval);
  put_columns(from.distance.time_interval_ns, 1, rows, columns, intervals);
  put_columns(from.distance.over_loss, 1, rows, columns, to.distance.over_loss);
}

/// With a root node the vectors are already in the world (ImuResampler::rows), so the mounting does
/// not change them. Without a root node, they are converted from the sensor's axes to the bone's.
void apply_mounting(const ImuGroup& group, const Mounting& mounting, ImuRows& rows) {
  const std::size_t nodes = group.node_names.size();
  for (std::size_t s = 0; s < nodes; ++s) {
    const auto worn = mounting.find(group.node_names[s]);
    if (worn == mounting.end()) continue;
    const Quat sensor_from_bone = quat(worn->second, 0).normalized();
    const Quat back = sensor_from_bone.conjugate();
    const bool in_world = !group.root_node.empty();
    for (std::size_t i = s; i < rows.valid.size(); i += nodes) {
      if (rows.valid[i] == 0) continue;
      if (group.content.orientation) {
        put_quat(rows.orientation, i, quat(rows.orientation, i) * sensor_from_bone);
      }
      if (in_world) continue;
      if (group.content.acceleration) {
        auto a = vec3(std::span(rows.acceleration), i);
        a = (back * a).eval();
      }
      if (group.content.angular_velocity) {
        auto w = vec3(std::span(rows.angular_velocity), i);
        w = (back * w).eval();
      }
    }
  }
}

namespace {

/// Sets all nodes of a row to zero and invalid. Without the root, no node can be converted to the
/// root's space.
void clear_row(const ImuGroup& group, std::size_t first, ImuRows& rows) {
  const std::size_t nodes = group.node_names.size();
  const auto zero = [first, nodes](std::vector<double>& values, std::size_t width) {
    if (values.empty()) return;
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first * width);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(nodes * width), 0.0);
  };
  zero(rows.orientation, 4);
  zero(rows.acceleration, 3);
  zero(rows.angular_velocity, 3);
  const auto valid = rows.valid.begin() + static_cast<std::ptrdiff_t>(first);
  std::fill(valid, valid + static_cast<std::ptrdiff_t>(nodes), std::uint8_t{0});
}

/// Orientation and acceleration of the root node in one row. The acceleration is in the world's
/// axes.
struct RootPose {
  Quat to_root;
  Vec3 acceleration;
};

/// Converts one node of a row to the root's space. The root's acceleration is subtracted in the
/// world's axes, before the rotation. This also removes gravity.
void turn_node(const RootPose& root, bool is_root, std::size_t i, ImuRows& rows) {
  if (!is_root) put_quat(rows.orientation, i, root.to_root * quat(rows.orientation, i));
  if (!rows.acceleration.empty()) {
    auto a = vec3(std::span(rows.acceleration), i);
    // The root keeps its own acceleration, as in DIP.
    a = (root.to_root * (is_root ? Vec3(a) : Vec3(a - root.acceleration))).eval();
  }
  if (!rows.angular_velocity.empty()) {
    auto w = vec3(std::span(rows.angular_velocity), i);
    w = (root.to_root * w).eval();
  }
}

}  // namespace

void bring_to_root(const ImuGroup& group, ImuRows& rows) {
  const std::size_t nodes = group.node_names.size();
  const std::size_t root = *index_of(group.node_names, group.root_node);
  for (std::size_t first = 0; first < rows.valid.size(); first += nodes) {
    if (rows.valid[first + root] == 0) {
      clear_row(group, first, rows);
      continue;
    }
    // The root's pose is read before the loop changes the row.
    RootPose pose{quat(rows.orientation, first + root).conjugate(), Vec3::Zero()};
    if (group.content.acceleration) {
      pose.acceleration = vec3(std::span(rows.acceleration), first + root);
    }
    for (std::size_t i = first; i < first + nodes; ++i) {
      if (rows.valid[i] != 0) turn_node(pose, i == first + root, i, rows);
    }
  }
}

namespace {

/// Rotates the vectors of one node from the root's space into the node's own space.
/// `root_acceleration` is in the world. Adding it restores gravity.
void turn_back(const Quat& from_root, const Vec3& root_acceleration, std::size_t i, ImuRows& rows) {
  const Quat to_node = quat(rows.orientation, i).conjugate();
  if (!rows.acceleration.empty()) {
    auto a = vec3(std::span(rows.acceleration), i);
    a = (to_node * (from_root * Vec3(a) + root_acceleration)).eval();
  }
  if (!rows.angular_velocity.empty()) {
    auto w = vec3(std::span(rows.angular_velocity), i);
    w = (to_node * (from_root * Vec3(w))).eval();
  }
}

}  // namespace

void bring_from_root(const ImuGroup& group, ImuRows& rows) {
  const std::size_t nodes = group.node_names.size();
  const std::size_t root = *index_of(group.node_names, group.root_node);
  for (std::size_t first = 0; first < rows.valid.size(); first += nodes) {
    if (rows.valid[first + root] == 0) continue;
    const Quat from_root = quat(rows.orientation, first + root);
    Vec3 acceleration = Vec3::Zero();
    // The root's own acceleration was only rotated, so the inverse rotation gives its value in the
    // world.
    if (!rows.acceleration.empty()) {
      acceleration = from_root * vec3(std::span(rows.acceleration), first + root);
    }
    for (std::size_t i = first; i < first + nodes; ++i) {
      if (rows.valid[i] == 0) continue;
      const bool is_root = i == first + root;
      // The orientation is converted first, because turn_back() needs the orientation in the world.
      if (!is_root) put_quat(rows.orientation, i, from_root * quat(rows.orientation, i));
      turn_back(from_root, is_root ? Vec3::Zero() : acceleration, i, rows);
    }
  }
}

}  // namespace kinalign
