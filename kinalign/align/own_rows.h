// SPDX-License-Identifier: Apache-2.0
// Makes the rows of a take from a stream's own frames, without resampling.
#pragma once

#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"
#include "kinalign/take/take.h"

#include <cstddef>

namespace kinalign {

/// Computes global positions of all `count` rows from the local ones; zeros for rows that are not
/// valid.
void fill_positions(const Skeleton& skeleton, ClipRows& rows, std::size_t count);

ClipRows own_rows(const Skeleton& skeleton, ClipFrames frames);
/// A point is valid unless it is missing.
PointRows own_rows(PointFrames frames);

}  // namespace kinalign
