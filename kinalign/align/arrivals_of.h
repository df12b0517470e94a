// SPDX-License-Identifier: Apache-2.0
// Every sample of some streams, read and thrown away: what `check` tells of them.
#pragma once

#include "kinalign/core/progress.h"
#include "kinalign/motion/arrivals.h"
#include "kinalign/resample/window.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <functional>
#include <vector>

namespace kinalign {

/// How late the samples of each stream were stamped, by the step that alignment takes for its usual
/// one (`step_of`, see taken_step()). All streams are read to their ends, side by side. Fails where
/// a value can't be read.
Result<std::vector<Arrivals>> arrivals_of(
    const std::vector<RecordedStream>& streams,
    const std::function<TakenStep(const RecordedStream&)>& step_of, const Progress& progress);

}  // namespace kinalign
