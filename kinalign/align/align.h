// SPDX-License-Identifier: Apache-2.0
// Makes a take from a recording (paper sections 3.1 and 3.2): one grid and one space, in blocks of
// rows (slabs).
#pragma once

#include "kinalign/core/progress.h"
#include "kinalign/take/take.h"

#include <functional>

namespace kinalign {

/// The receiver of a take: first the header, then slabs in order. A slab is valid during the call
/// only. An error of a function ends the alignment and becomes its result.
struct TakeSink {
  std::function<Result<void>(const TakeHeader&)> begin;
  std::function<Result<void>(const TakeSlab&)> rows;
};

/// Aligns a recording in one pass over each stream, with memory for some thousand rows. A fitted
/// transform needs one more pass; a reference that is cut by the common span needs one more pass
/// over its stamps. Returns the report; its figures describe the rows given to the sink. Fails if
/// streams do not overlap in time or a stream can't be read again. With two `jobs` the reference is
/// read ahead while earlier rows are made; the results are the same. `sink` and `progress` may be
/// called from another thread, but never from two at once.
Result<AlignmentReport> align(const Recording& recording, const Manifest& manifest,
                              const TakeSink& sink, const Progress& progress = {},
                              std::size_t jobs = 1);

/// Aligns as above, but returns the whole take in memory.
Result<Take> align(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
