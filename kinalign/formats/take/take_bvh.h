// SPDX-License-Identifier: Apache-2.0
// A take as a BVH.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/formats/bvh/bvh.h"

#include <string>

namespace kinalign {

/// Writes the first skeleton's stream of a take. A BVH has a fixed step and marks nothing: a row
/// that is not valid gets the pose of the last valid row, or of the first valid row if none comes
/// before it. Reads the take twice in slabs, because the channels are known only after the first
/// pass. Returns what was lost, as findings. Call it only where a take may be opened (guarded.h).
Result<Findings> take_to_bvh(FileSystem& files, const std::string& from, const TextSink& sink);

}  // namespace kinalign
