// SPDX-License-Identifier: Apache-2.0
// Writes a stream of a take as a table that any program can read.
#pragma once

#include "kinalign/dataset/export/exported_take.h"

namespace kinalign {

/// Writes a line of names, then a line for each row: the column time_ns, and one column for each
/// number. A column is named ARRAY.JOINT.AXIS, with the array's name in docs/formats/take.md.
/// Numbers have the digits needed to read them back exactly.
Result<void> write_stream_csv(ExportedTake& take, std::size_t group, FileSystem& files,
                              const std::string& path);

/// Writes the facts that the tables lack: kinds, skeletons, gravity of nodes, units of all arrays.
Result<void> write_streams_json(ExportedTake& take, FileSystem& files, const std::string& path);
std::string streams_json(const TakeHeader& header);

}  // namespace kinalign
