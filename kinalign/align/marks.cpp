// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/marks.h"

#include "kinalign/clock/time_model.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Adds one valid sample. `row` is its index in the distances, `cell` its index in over_loss.
void add_valid(const SampleDistance& distance, std::size_t row, std::size_t cell, Marks& marks) {
  // A reference has no distances: its vectors are empty, so nothing is added.
  if (!distance.over_loss.empty()) marks.bridged += distance.over_loss[cell];
  if (!distance.time_interval_ns.empty()) {
    marks.unsure += distance.time_interval_ns[row] == no_interval ? 1 : 0;
  }
  if (distance.nearest_raw_ns.empty()) return;
  marks.worst_nearest_ns = std::max(marks.worst_nearest_ns, distance.nearest_raw_ns[row]);
}

}  // namespace

void add_marks(const ClipRows& rows, Marks& marks) {
  // For the reference skeleton `valid` is empty, so no sample is added.
  marks.samples += rows.valid.size();
  for (std::size_t r = 0; r < rows.valid.size(); ++r) {
    if (rows.valid[r] == 0) {
      ++marks.invalid;
      ++marks.empty_rows;
    } else {
      add_valid(rows.distance, r, r, marks);
    }
  }
}

void add_marks(const PointRows& rows, std::size_t joints, Marks& marks) {
  marks.samples += rows.valid.size();
  for (std::size_t row = 0; row * joints < rows.valid.size(); ++row) {
    std::uint64_t valid = 0;
    for (std::size_t cell = row * joints; cell < (row + 1) * joints; ++cell) {
      if (rows.valid[cell] == 0) continue;
      ++valid;
      marks.inferred += rows.state[cell] == Tracking::inferred ? 1 : 0;
      add_valid(rows.distance, row, cell, marks);
    }
    marks.invalid += joints - valid;
    marks.empty_rows += valid == 0 ? 1 : 0;
  }
}

void add_marks(const ImuRows& rows, const NodeColumns& columns, std::size_t count, Marks& marks) {
  // The rows of a group also contain the nodes of other streams. Only `count` columns from `first`
  // on are counted.
  for (std::size_t row = 0; row < rows.valid.size(); row += columns.all) {
    std::uint64_t valid = 0;
    for (std::size_t cell = row + columns.first; cell < row + columns.first + count; ++cell) {
      if (rows.valid[cell] == 0) continue;
      ++valid;
      add_valid(rows.distance, cell, cell, marks);
    }
    marks.samples += count;
    marks.invalid += count - valid;
    marks.empty_rows += valid == 0 ? 1 : 0;
  }
}

}  // namespace kinalign
