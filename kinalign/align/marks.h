// SPDX-License-Identifier: Apache-2.0
// Counts valid and invalid samples in the final rows of a take. At that stage, rows without a
// required root joint or root node are already invalid. The reference is the stream whose stamps
// are the grid.
#pragma once

#include "kinalign/align/nodes.h"
#include "kinalign/take/take.h"

#include <cstdint>

namespace kinalign {

/// The counts of one stream over the rows of a take. `samples` counts joints or nodes, `empty_rows`
/// counts rows, because one lost joint and a lost body are different faults.
struct Marks {
  std::uint64_t samples = 0;  // rows x joints (or nodes); for a skeleton the rows
  std::uint64_t invalid = 0, inferred = 0, bridged = 0;
  std::uint64_t empty_rows = 0;  // rows without any valid sample
  /// Valid samples without a time interval, if other samples of the stream have one.
  std::uint64_t unsure = 0;
  std::int64_t worst_nearest_ns = 0;  // over valid samples: longest time to the nearest raw sample
};

/// Adds the counts of a resampled skeleton. For a reference skeleton only the rows are counted.
void add_marks(const ClipRows& rows, Marks& marks);
void add_marks(const PointRows& rows, std::size_t joints, Marks& marks);
/// Adds the counts of `count` nodes in their columns of a group.
void add_marks(const ImuRows& rows, const NodeColumns& columns, std::size_t count, Marks& marks);

}  // namespace kinalign
