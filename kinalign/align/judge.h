// SPDX-License-Identifier: Apache-2.0
// Findings that a user could overlook in an alignment. Each finding states the fault and its
// repair.
#pragma once

#include "kinalign/align/plan.h"
#include "kinalign/align/space.h"
#include "kinalign/take/take.h"

namespace kinalign {

/// Finds stamps that repeat, step back, jump ahead, come in bursts, have another unit than assumed,
/// or have another rate than stated.
Findings judge_stamps(const RecordedStream& stream, const StreamOptions& options);

/// Finds samples that were delayed and stamped on arrival.
Findings judge_arrivals(const RecordedStream& stream, const Arrivals& arrivals, Role role);

/// Warns if start_ns is given (the time of the first sample) but the first sample is not reliable.
Findings judge_start(const RecordedStream& stream, const StreamOptions& options,
                     const Arrivals& arrivals);

/// The findings of a stream. If another stream reads the same file, the findings name the stream.
Findings with_stream_name(const RecordedStream& stream, const Recording& recording,
                          Findings findings);

/// Warns if a stream has content too fast for a grid of `grid_hz`.
Findings judge_content(const RecordedStream& stream, const ResampleCount& count, double grid_hz);

/// Findings that need no samples: streams that share little of their time, streams that stay in
/// their own space without a request, streams that read the same bytes.
Findings judge_plan(const Recording& recording, const AlignPlan& plan);

/// Warns if a stream has no valid sample in most of the take's `rows`.
Findings judge_rows(const StreamReport& stream, std::uint64_t rows);

/// Warns if joints are too far from their counterparts to be the same ones.
Findings judge_residual(const SpaceReport& space);

/// Warns if the joints of a fit are so close to one line that the rotation about that line is
/// uncertain.
Findings judge_fit(const SpacePlan& plan, const SpaceReport& space);

}  // namespace kinalign
