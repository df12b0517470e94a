// SPDX-License-Identifier: Apache-2.0
// What a take's rows say of themselves in the end: a row without the root of its nodes, or of the
// paper's method, has lost its samples by then.
#pragma once

#include "kinalign/align/nodes.h"
#include "kinalign/take/take.h"

#include <cstdint>

namespace kinalign {

struct Marks {
  std::uint64_t samples = 0;  // rows x joints (or nodes); of a skeleton rows
  std::uint64_t invalid = 0, inferred = 0, bridged = 0;
  std::uint64_t empty_rows = 0;       // nothing in them is valid
  std::uint64_t unsure = 0;           // valid, without an interval that others of the stream have
  std::int64_t worst_nearest_ns = 0;  // over valid samples
};

/// Adds those of a skeleton that was resampled; of the reference nothing is known but its rows.
void add_marks(const ClipRows& rows, Marks& marks);
void add_marks(const PointRows& rows, std::size_t joints, Marks& marks);
/// Of `count` nodes' columns of a group.
void add_marks(const ImuRows& rows, const NodeColumns& columns, std::size_t count, Marks& marks);

}  // namespace kinalign
