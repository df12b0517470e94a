// SPDX-License-Identifier: Apache-2.0
// Writes a take as a BVH.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bvh/bvh.h"

#include <string>

namespace kinalign {

/// Writes the stream of the first skeleton in a take. A BVH has a fixed step and can't mark rows.
/// An invalid row therefore gets the pose of the last valid row or, before the first valid row, the
/// pose of that one. Reads the take twice in slabs, because the channels are known only after the
/// first pass. Returns the losses as findings. Call it only where a take may be opened (guarded.h).
Result<Findings> take_to_bvh(FileSystem& files, const std::string& from, const FileSink& sink);

}  // namespace kinalign
