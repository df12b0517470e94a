// SPDX-License-Identifier: Apache-2.0
// Every sample of a stream, read and thrown away: what `check` tells of it.
#pragma once

#include "kinalign/core/progress.h"
#include "kinalign/motion/arrivals.h"
#include "kinalign/resample/window.h"
#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

namespace kinalign {

/// How late its samples were stamped, by the step that alignment takes for its usual one. Fails
/// where a value can't be read.
Result<Arrivals> arrivals_of(const RecordedStream& stream, const StreamOptions& options, Role role,
                             const Progress& progress);

}  // namespace kinalign
