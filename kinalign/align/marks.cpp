// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/marks.h"

#include <algorithm>

namespace kinalign {

namespace {

/// Of one sample: of a row of `distance`, and where it lies among what was marked over_loss.
void add_valid(const SampleDistance& distance, std::size_t row, std::size_t cell, Marks& marks) {
  if (!distance.over_loss.empty()) marks.bridged += distance.over_loss[cell];
  if (distance.nearest_raw_ns.empty()) return;
  marks.worst_nearest_ns = std::max(marks.worst_nearest_ns, distance.nearest_raw_ns[row]);
}

}  // namespace

void add_marks(const ClipRows& rows, Marks& marks) {
  marks.samples += rows.valid.size();
  for (std::size_t r = 0; r < rows.valid.size(); ++r) {
    if (rows.valid[r] == 0) {
      ++marks.invalid;
    } else {
      add_valid(rows.distance, r, r, marks);
    }
  }
}

void add_marks(const PointRows& rows, std::size_t joints, Marks& marks) {
  marks.samples += rows.valid.size();
  for (std::size_t cell = 0; cell < rows.valid.size(); ++cell) {
    if (rows.valid[cell] == 0) {
      ++marks.invalid;
      continue;
    }
    marks.inferred += rows.state[cell] == Tracking::inferred ? 1 : 0;
    add_valid(rows.distance, cell / joints, cell, marks);
  }
}

void add_marks(const ImuRows& rows, const NodeColumns& columns, std::size_t count, Marks& marks) {
  for (std::size_t row = 0; row < rows.valid.size(); row += columns.all) {
    for (std::size_t cell = row + columns.first; cell < row + columns.first + count; ++cell) {
      ++marks.samples;
      if (rows.valid[cell] == 0) {
        ++marks.invalid;
      } else {
        add_valid(rows.distance, cell, cell, marks);
      }
    }
  }
}

}  // namespace kinalign
