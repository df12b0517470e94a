// SPDX-License-Identifier: Apache-2.0
// Moves nodes from their streams into the columns of their group and into one space.
#pragma once

#include "kinalign/take/take.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Rotations sensor_from_bone by node name: how nodes are worn. A node without an entry has the
/// identity.
using Mounting = std::map<std::string, std::vector<double>>;

/// The columns of a stream's nodes among all nodes of a group. Several streams, usually one per
/// node, fill one group of `all` columns.
struct NodeColumns {
  std::size_t first = 0, all = 0;
};

/// Copies `rows` rows of a stream's nodes into the rows of its group.
void put_nodes(const ImuRows& from, std::size_t rows, const NodeColumns& columns, ImuRows& to);

/// Converts orientations of sensors to those of bones. Vectors that are not in the world are
/// rotated into the bone's space.
void apply_mounting(const ImuGroup& group, const Mounting& mounting, ImuRows& rows);

/// Brings all nodes into the space of the root node, as DIP does (Huang et al., SIGGRAPH Asia 2018,
/// section 4.3): orientation root^-1 q, acceleration root^-1 (a - a_root), angular velocity root^-1
/// w. The root keeps its orientation in the world; its acceleration becomes root^-1 a. Vectors must
/// be in the world's space. Rows without the root become invalid.
void bring_to_root(const ImuGroup& group, ImuRows& rows);

/// The inverse of bring_to_root(): orientations in the world, vectors in each node's own space.
/// Rows without the root stay invalid. If all accelerations contained gravity, they contain it
/// again.
void bring_from_root(const ImuGroup& group, ImuRows& rows);

}  // namespace kinalign
