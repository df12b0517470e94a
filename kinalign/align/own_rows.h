// SPDX-License-Identifier: Apache-2.0
// Makes rows of a take directly from a stream's frames, without resampling.
#pragma once

#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"
#include "kinalign/take/take.h"

#include <cstddef>

namespace kinalign {

/// Computes the global positions of all `count` rows from the local positions and rotations.
/// Invalid rows get zeros.
void fill_positions(const Skeleton& skeleton, ClipRows& rows, std::size_t count);

/// All rows are valid; `valid` stays empty.
ClipRows own_rows(const Skeleton& skeleton, ClipFrames frames);
/// A point is valid unless it is missing.
PointRows own_rows(PointFrames frames);

}  // namespace kinalign
