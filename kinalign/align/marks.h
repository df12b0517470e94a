// SPDX-License-Identifier: Apache-2.0
// Counts validity in the final rows of a take. A row without the root of its nodes, or without the
// root of the paper's method, has lost its samples by then.
#pragma once

#include "kinalign/align/nodes.h"
#include "kinalign/take/take.h"

#include <cstdint>

namespace kinalign {

/// The counts of one stream over the rows of a take. `samples` counts cells, `empty_rows` counts
/// rows: one lost joint and a lost body are different faults.
struct Marks {
  std::uint64_t samples = 0;  // rows x joints (or nodes); for a skeleton the rows
  std::uint64_t invalid = 0, inferred = 0, bridged = 0;
  std::uint64_t empty_rows = 0;  // rows without any valid sample
  /// Valid samples without a time interval, in a stream that has intervals.
  std::uint64_t unsure = 0;
  std::int64_t worst_nearest_ns = 0;  // over valid samples; distance to the nearest raw sample
};

/// Adds the counts of a resampled skeleton. Of a reference skeleton only the rows are known.
void add_marks(const ClipRows& rows, Marks& marks);
void add_marks(const PointRows& rows, std::size_t joints, Marks& marks);
/// Adds the counts of `count` nodes, in their columns of a group.
void add_marks(const ImuRows& rows, const NodeColumns& columns, std::size_t count, Marks& marks);

}  // namespace kinalign
