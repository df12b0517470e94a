// SPDX-License-Identifier: Apache-2.0
// The nodes of one stream, out of a take, a recording, a manifest or a device's file.
#pragma once

#include "apps/cli/verb.h"

#include "kinalign/models/pose/even_nodes.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

struct NamedNodes {
  std::string stream;
  std::vector<std::string> names;         // [S]
  std::vector<NodeTrack> tracks;          // [S] in each node's own space
  std::vector<std::optional<Quat>> worn;  // [S] CalibrationOptions::worn, by a stated mounting
  std::vector<std::string> warnings{};    // of the file's reader
};

/// `stream`: its name; empty: the only stream of nodes. Samples that are not valid, and stamps that
/// repeat or step back, are left out. A root's space is left. Takes: only in a child process
/// (guarded.h).
Result<NamedNodes> nodes_of_take(FileSystem& files, const std::string& path,
                                 const std::string& stream);
Result<NamedNodes> nodes_of_file(const std::string& path, const std::string& stream, Call& call);

}  // namespace kinalign
