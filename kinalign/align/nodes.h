// SPDX-License-Identifier: Apache-2.0
// Puts nodes from their streams into the columns of their group, and converts them to one space.
#pragma once

#include "kinalign/take/take.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// The rotation sensor_from_bone for each node name: how the node is worn. A node without an entry
/// has no rotation.
using Mounting = std::map<std::string, std::vector<double>>;

/// The columns of one stream's nodes among the `all` columns of a group. Several streams, usually
/// one per node, share a group.
struct NodeColumns {
  std::size_t first = 0, all = 0;
};

/// Copies `rows` rows of a stream's nodes into the rows of their group.
void put_nodes(const ImuRows& from, std::size_t rows, const NodeColumns& columns, ImuRows& to);

/// Converts orientations of sensors to orientations of bones. Vectors in the axes of the sensor are
/// rotated into the axes of the bone.
void apply_mounting(const ImuGroup& group, const Mounting& mounting, ImuRows& rows);

/// Converts all nodes to the space of the root node, as in DIP (Huang et al., SIGGRAPH Asia 2018,
/// section 4.3): orientation root^-1 q, acceleration root^-1 (a - a_root), angular velocity root^-1
/// w. The root keeps its orientation in the world; its acceleration becomes root^-1 a. Vectors must
/// be in the world's space. Rows without a valid root become invalid.
void bring_to_root(const ImuGroup& group, ImuRows& rows);

/// The inverse of bring_to_root(). Orientations are in the world and vectors in each node's own
/// space. Rows without a valid root stay invalid. If all accelerations contained gravity, they
/// contain gravity again.
void bring_from_root(const ImuGroup& group, ImuRows& rows);

}  // namespace kinalign
