// SPDX-License-Identifier: Apache-2.0
// Reads the nodes of one stream from a take, a recording, a manifest or a device's file.
#pragma once

#include "apps/kinalign/learn/motion_input.h"

#include "kinalign/models/pose/even_nodes.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Nodes with their names and samples. All arrays have one element for each node, in the same
/// order. Each track has its own stamps, since nodes do not sample at the same time.
struct NamedNodes {
  std::string stream;
  std::vector<std::string> names;         // for each node
  std::vector<NodeTrack> tracks;          // samples in each node's own coordinates
  std::vector<std::optional<Quat>> worn;  // the stated mounting, for CalibrationOptions::worn
  std::vector<std::string> warnings{};    // from the file's reader
};

/// Reads the nodes of a take. Invalid samples, and samples whose stamps repeat or step back, are
/// left out. Nodes that the take gives relative to the root are converted to their own coordinates.
/// Only a child process may read a take (guarded.h).
Result<NamedNodes> nodes_of_take(FileSystem& files, const std::string& path,
                                 const WantedStream& stream);
/// Reads the nodes of any file. Streams of the same name, one for each device, are joined.
Result<NamedNodes> nodes_of(const std::string& path, const WantedStream& stream, Call& call);

}  // namespace kinalign
