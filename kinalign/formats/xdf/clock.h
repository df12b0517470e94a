// SPDX-License-Identifier: Apache-2.0
// From a stream's clock offsets, as XDF has them, to its stamps on the recorder's clock: a robust
// line for each stretch between resets of the sender's clock, as pyxdf does it (the Huber loss
// above 0.1 ms). docs/formats/xdf.md.
#pragma once

#include "kinalign/formats/xdf/xdf.h"

namespace kinalign {

/// Between two resets. What to add to a stamp: offset + slope * (stamp - origin).
struct XdfClockLine {
  double first = 0.0, last = 0.0;  // s, times of the first and last offset
  double origin = 0.0;             // s
  double offset = 0.0;             // s, at the origin
  double slope = 0.0;              // s/s; 0 where there is one offset only
  std::size_t offsets = 0;
  double rms_residual = 0.0;      // s, of all offsets, outliers too
  double largest_residual = 0.0;  // s
};

/// Offsets of one stream in the order of the file, below 1e15 s as XdfReader gives them. A reset:
/// their time steps back, or the offset by more than a second and the next one, too, is nearer to
/// the new than to the old. What steps out and back again is an outlier.
std::vector<XdfClockLine> fit_xdf_clock(std::span<const XdfClockOffset> offsets);

/// The stamp on the recorder's clock by the line that is nearest to it in time, the later one of
/// two; as it is where there is none.
double corrected_xdf_stamp(std::span<const XdfClockLine> lines, double stamp);

}  // namespace kinalign
