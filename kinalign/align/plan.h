// SPDX-License-Identifier: Apache-2.0
// The plan of an alignment, made before any sample is read: the reference, the common span, the
// number of rows, the resampling of each stream, and its group.
#pragma once

#include "kinalign/resample/resample.h"
#include "kinalign/take/take.h"

#include <cstdint>
#include <vector>

namespace kinalign {

/// The plan of one stream: its columns in the take and the rule by which it is resampled.
struct StreamPlan {
  std::size_t group = 0;       // index of the group in the take's header
  std::size_t first_node = 0;  // first column of the stream in a group of nodes
  ResampleRule rule;
};

/// Everything that is decided before rows are made. It does not change afterwards; all passes use
/// the same plan.
struct AlignPlan {
  std::size_t reference = 0;        // index of the stream whose stamps are the grid
  Time begin{}, end{};              // common span, both included, on the take's axis
  std::vector<StreamPlan> streams;  // in the order of the recording
  TakeHeader header;
};

/// Fails if streams do not overlap in time, if names repeat or are not allowed for a group, or if
/// the manifest names something absent or sets an option without effect (unused_options.h).
Result<AlignPlan> plan_alignment(const Recording& recording, const Manifest& manifest);

/// The stream whose stamps are the grid: the one named in the manifest, else the first.
std::string reference_name(const Recording& recording, const Manifest& manifest);

}  // namespace kinalign
