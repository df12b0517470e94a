// SPDX-License-Identifier: Apache-2.0
// What alignment will do, decided before any sample is touched: the reference, the common span,
// the number of rows, how each stream is resampled and where it goes.
#pragma once

#include "kinalign/resample/resample.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <vector>

namespace kinalign {

struct StreamPlan {
  std::size_t group = 0;       // of the take's header
  std::size_t first_node = 0;  // of a group of nodes, the stream's first column
  ResampleRule rule;
};

struct AlignPlan {
  std::size_t reference = 0;        // stream whose stamps are the grid
  Time begin{}, end{};              // common span, both included, on the take's axis
  std::vector<StreamPlan> streams;  // as in the recording
  TakeHeader header;
};

/// Fails where streams do not overlap in time, names repeat or could be no group of a take, or the
/// manifest names what is not there or says what has no effect (unused_options.h).
Result<AlignPlan> plan_alignment(const Recording& recording, const Manifest& manifest);

/// The stream whose stamps are the grid: the one that is said, else the first.
std::string reference_name(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
