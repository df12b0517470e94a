// SPDX-License-Identifier: Apache-2.0
// From a recording to a take (paper sections 3.1 and 3.2): one grid, one space, slab by slab.
#pragma once

#include "kinalign/core/progress.h"
#include "kinalign/take/take.h"

#include <functional>

namespace kinalign {

/// Where a take goes: the header first, then slabs in order.
struct TakeSink {
  std::function<Result<void>(const TakeHeader&)> begin;
  std::function<Result<void>(const TakeSlab&)> rows;
};

/// Aligns in one pass over each stream (after one more where a transform is fitted, and one over
/// the stamps of a reference that the span cuts) and memory for some thousand rows. Returns the
/// report, whose figures belong to what was handed to the sink. Fails where streams do not overlap
/// in time or a stream can't be read again. With two `jobs` the reference is read ahead while the
/// rows before are made; results are the same. `sink` and `progress` may be called on another
/// thread, never on two at once.
Result<AlignmentReport> align(const Recording& recording, const Manifest& manifest,
                              const TakeSink& sink, const Progress& progress = {},
                              std::size_t jobs = 1);

/// The same, into memory.
Result<Take> align(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
