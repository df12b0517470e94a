// SPDX-License-Identifier: Apache-2.0
// Nodes of one group, brought from their streams into the group's columns and into one space.
#pragma once

#include "kinalign/take/take.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// How nodes are worn: by node, sensor_from_bone. Nodes without one: the identity.
using Mounting = std::map<std::string, std::vector<double>>;

/// Where a stream's nodes stand among all the nodes of a group.
struct NodeColumns {
  std::size_t first = 0, all = 0;
};

/// Copies a stream's `rows` rows of some nodes into a group's rows of all.
void put_nodes(const ImuRows& from, std::size_t rows, const NodeColumns& columns, ImuRows& to);

/// Orientations become the bones'; vectors that are not in the world turn with them.
void apply_mounting(const ImuGroup& group, const Mounting& mounting, ImuRows& rows);

/// All nodes into the root node's space, as DIP does (Huang et al., SIGGRAPH Asia 2018, section
/// 4.3): orientation root^-1 q, acceleration root^-1 (a - a_root), angular velocity root^-1 w;
/// the root keeps its orientation in the world, its acceleration is root^-1 a. Vectors come in the
/// world's space. Rows without the root are invalid.
void bring_to_root(const ImuGroup& group, ImuRows& rows);

/// The way back from bring_to_root(): orientations in the world, vectors in each node's own space.
/// Rows without the root stay invalid. Where gravity stood in all accelerations it does so again.
void bring_from_root(const ImuGroup& group, ImuRows& rows);

}  // namespace kinalign
