// SPDX-License-Identifier: Apache-2.0
// Makes a take from a recording: all streams on one grid of stamps and in one space (HFUT-MMD
// paper, sections 3.1 and 3.2). The rows are made in blocks ("slabs").
#pragma once

#include "kinalign/core/progress.h"
#include "kinalign/take/take.h"

#include <functional>

namespace kinalign {

/// The receiver of a take. It gets the header first, then the slabs in order. A slab is valid only
/// during the call. If a function returns an error, the alignment ends with that error.
struct TakeSink {
  std::function<Result<void>(const TakeHeader&)> begin;
  std::function<Result<void>(const TakeSlab&)> rows;
};

/// Aligns a recording in one pass over each stream, with memory for a few thousand rows. The grid
/// is the stamps of one stream, the reference. A fitted transform needs one more pass. If the
/// reference begins before or ends after the common time span, one more pass reads its stamps.
///
/// Returns the report, which describes the rows given to the sink. Fails if the streams do not
/// overlap in time or a stream can't be read again. With two `jobs` the reference is read in
/// advance while earlier rows are made; the results are the same. `sink` and `progress` may be
/// called from another thread, but never from two threads at once.
Result<AlignmentReport> align(const Recording& recording, const Manifest& manifest,
                              const TakeSink& sink, const Progress& progress = {},
                              std::size_t jobs = 1);

/// Aligns as the function above, but returns the whole take in memory.
Result<Take> align(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
