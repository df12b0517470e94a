// SPDX-License-Identifier: Apache-2.0
// Reads the nodes of one stream from a take, a recording, a manifest or a device's file.
#pragma once

#include "apps/kinalign/learn/motion_input.h"

#include "kinalign/models/pose/even_nodes.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// All arrays have one entry for each of the S nodes, in the same order. The tracks have their own
/// stamps, since nodes do not sample together.
struct NamedNodes {
  std::string stream;
  std::vector<std::string> names;         // [S]
  std::vector<NodeTrack> tracks;          // [S] in each node's own space
  std::vector<std::optional<Quat>> worn;  // [S] for CalibrationOptions::worn, from a stated
                                          // mounting
  std::vector<std::string> warnings{};    // from the file's reader
};

/// Samples that are not valid, and stamps that repeat or step back, are left out. Nodes in the
/// space of a root are brought back to their own space. Takes may be read only in a child process
/// (guarded.h).
Result<NamedNodes> nodes_of_take(FileSystem& files, const std::string& path,
                                 const WantedStream& stream);
/// The same for any file. Several streams of that name (one for each device) are joined.
Result<NamedNodes> nodes_of(const std::string& path, const WantedStream& stream, Call& call);

}  // namespace kinalign
