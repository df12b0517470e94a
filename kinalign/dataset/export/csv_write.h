// SPDX-License-Identifier: Apache-2.0
// A stream of a take as a table that any program reads.
#pragma once

#include "kinalign/dataset/export/exported_take.h"

namespace kinalign {

/// A line of names, then a row for each of the take's: time_ns, and a column for each number, named
/// ARRAY.JOINT.AXIS as docs/formats/take.md names the arrays. Numbers have the digits that give the
/// stored number again.
Result<void> write_stream_csv(ExportedTake& take, std::size_t group, FileSystem& files,
                              const std::string& path);

/// Facts that the tables lack: kinds, skeletons, nodes' gravity, units of every array.
Result<void> write_streams_json(ExportedTake& take, FileSystem& files, const std::string& path);
std::string streams_json(const TakeHeader& header);

}  // namespace kinalign
