// SPDX-License-Identifier: Apache-2.0
// The plan of an alignment, made before any sample is read. It contains the reference (the stream
// whose stamps are the grid), the common time span, the number of rows, and the group and
// resampling of each stream.
#pragma once

#include "kinalign/resample/resample.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <vector>

namespace kinalign {

/// The plan of one stream: its columns in the take and its parameters of resampling.
struct StreamPlan {
  std::size_t group = 0;       // index of the group in the take's header
  std::size_t first_node = 0;  // first column of the stream in a group of nodes
  ResampleRule rule;
};

/// All decisions that are made before the first row. They do not change later; all passes use the
/// same plan.
struct AlignPlan {
  std::size_t reference = 0;        // index of the stream whose stamps are the grid
  Time begin{}, end{};              // common time span, both ends included, on the take's axis
  std::vector<StreamPlan> streams;  // in the order of the recording
  TakeHeader header;
};

/// Fails if streams do not overlap in time, or if their names repeat or can't be group names. Also
/// fails if the manifest names something that does not exist or sets an option that has no effect
/// (unused_options.h).
Result<AlignPlan> plan_alignment(const Recording& recording, const Manifest& manifest);

/// Returns the name of the reference: the stream named in the manifest, or else the first stream.
std::string reference_name(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
