// SPDX-License-Identifier: Apache-2.0
// Writes a take as a BVH file.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bvh/bvh.h"

#include <string>

namespace kinalign {

/// Writes the stream with the first skeleton of a take. A BVH file has a fixed frame time and can't
/// mark rows as invalid. An invalid row therefore gets the pose of the last valid row. Rows before
/// the first valid row get the pose of that row. The take is read twice in slabs (blocks of rows),
/// because the channels are known only after the first pass. Data that the BVH file does not
/// contain are reported as findings. Call this in a child process (guarded.h), because HDF5 opens
/// the take.
Result<Findings> take_to_bvh(FileSystem& files, const std::string& from, const FileSink& sink);

}  // namespace kinalign
