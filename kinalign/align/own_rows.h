// SPDX-License-Identifier: Apache-2.0
// A stream's own frames, not resampled, as the rows of a take.
#pragma once

#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"
#include "kinalign/take/take.h"

#include <cstddef>

namespace kinalign {

/// Global positions of all `count` rows from their local ones; zeros where a row is not valid.
void fill_positions(const Skeleton& skeleton, ClipRows& rows, std::size_t count);

ClipRows own_rows(const Skeleton& skeleton, ClipFrames frames);
/// Valid is what was seen.
PointRows own_rows(PointFrames frames);

}  // namespace kinalign
