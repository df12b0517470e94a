// SPDX-License-Identifier: Apache-2.0
// What a person should know of an alignment and could overlook: findings that say what is wrong and
// what would mend it.
#pragma once

#include "kinalign/align/plan.h"
#include "kinalign/align/space.h"
#include "kinalign/take/take.h"

namespace kinalign {

/// Stamps that repeat, step back, run ahead, come in bursts, in another unit than was thought, or
/// at another rate than the one stated.
Findings judge_stamps(const RecordedStream& stream, const StreamOptions& options);

/// Samples that were held back on their way and stamped where they arrived.
Findings judge_arrivals(const RecordedStream& stream, const Arrivals& arrivals, Role role);

/// A start_ns, which is the first sample's, where the first sample is none to go by.
Findings judge_start(const RecordedStream& stream, const StreamOptions& options,
                     const Arrivals& arrivals);

/// Findings of a stream; where another one reads the same file, they name the stream.
Findings said_of(const RecordedStream& stream, const Recording& recording, Findings findings);

/// What the grid of `grid_hz` can't carry of one stream.
Findings judge_content(const RecordedStream& stream, const ResampleCount& count, double grid_hz);

/// Known before a sample is touched: streams that share little of their time, that stay in a space
/// of their own though nobody said that they should, that read the same bytes.
Findings judge_plan(const Recording& recording, const AlignPlan& plan);

/// A stream that has nothing in most of the take's `rows`.
Findings judge_rows(const StreamReport& stream, std::uint64_t rows);

/// Joints that lie too far from their counterparts to be the same ones.
Findings judge_residual(const SpaceReport& space);

/// A fit by joints so near to a line that the turn about it is a guess.
Findings judge_fit(const SpacePlan& plan, const SpaceReport& space);

}  // namespace kinalign
