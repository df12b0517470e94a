// SPDX-License-Identifier: Apache-2.0
// Reads all samples of streams to find samples that were stamped too late. `check` reports the
// result.
#pragma once

#include "kinalign/core/progress.h"
#include "kinalign/motion/arrivals.h"
#include "kinalign/resample/window.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <functional>
#include <vector>

namespace kinalign {

/// Measures how late the samples of each stream were stamped. `step_of` returns the usual step of a
/// stream as alignment uses it (taken_step()). All streams are read to their ends in parallel.
/// Fails if a value can't be read.
Result<std::vector<Arrivals>> arrivals_of(
    const std::vector<RecordedStream>& streams,
    const std::function<TakenStep(const RecordedStream&)>& step_of, const Progress& progress);

}  // namespace kinalign
