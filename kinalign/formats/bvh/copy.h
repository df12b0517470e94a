// SPDX-License-Identifier: Apache-2.0
// A BVH, or the skeleton's stream of a take, into a BVH: two passes in pieces, so that neither has
// to fit into memory. What the rows are is known after the first, and so how many.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/bvh/bvh.h"

#include <string>

namespace kinalign {

/// A file's own channels, values and decimals; every number stays as it is. Returns what was odd
/// about the rows.
Result<Findings> copy_bvh(FileSystem& files, const std::string& from, const TextSink& sink,
                          const Progress& progress = {});

/// The first skeleton's stream of a take. A BVH has a fixed step and marks nothing: a row that is
/// not valid holds the pose of the last valid one (the first rows: of the first). Returns what got
/// lost so. To be called where takes may be opened (guarded.h).
Result<Findings> take_to_bvh(FileSystem& files, const std::string& from, const TextSink& sink);

}  // namespace kinalign
