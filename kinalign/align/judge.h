// SPDX-License-Identifier: Apache-2.0
// Makes findings about an alignment that a user could overlook. Each finding states the fault and
// its repair.
#pragma once

#include "kinalign/align/plan.h"
#include "kinalign/align/space.h"
#include "kinalign/take/take.h"

namespace kinalign {

/// Looks for stamps that repeat, go back, jump ahead or come in bursts, and for stamps whose unit
/// or rate is not the stated one.
Findings judge_stamps(const RecordedStream& stream, const StreamOptions& options);

/// Looks for samples that were delayed and stamped on arrival.
Findings judge_arrivals(const RecordedStream& stream, const Arrivals& arrivals, Role role);

/// Warns if the option start_ns (the time of the first sample) is given but the first sample is not
/// reliable.
Findings judge_start(const RecordedStream& stream, const StreamOptions& options,
                     const Arrivals& arrivals);

/// Returns the findings. If another stream reads the same file, they also name this stream.
Findings with_stream_name(const RecordedStream& stream, const Recording& recording,
                          Findings findings);

/// Warns if a stream contains motion that is too fast for a grid of `grid_hz`.
Findings judge_content(const RecordedStream& stream, const ResampleCount& count, double grid_hz);

/// Findings that need no samples: streams with little common time, streams that keep their own
/// space although the user did not ask for it, and streams that read the same bytes.
Findings judge_plan(const Recording& recording, const AlignPlan& plan);

/// Warns if a stream has no valid sample in more than half of the take's `rows`.
Findings judge_rows(const StreamReport& stream, std::uint64_t rows);

/// Warns if joints are so far from their counterparts that they can't be the same joints.
Findings judge_residual(const SpaceReport& space);

/// Warns if the joints of a fit are close to one line, because the rotation about that line is then
/// uncertain.
Findings judge_fit(const SpacePlan& plan, const SpaceReport& space);

}  // namespace kinalign
