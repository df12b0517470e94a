// SPDX-License-Identifier: Apache-2.0
// The step at which a device took its samples. Delayed samples are found by comparison with it.
#pragma once

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <cstdint>

namespace kinalign {

/// The role of a stream: its stamps are the grid (reference), or it is resampled to the grid.
enum class Role { reference, resampled };

/// A device's step. If ns is 0, the step is unknown and no delay is found. Delayed samples of the
/// reference are only counted; those of other streams are dropped.
struct TakenStep {
  std::int64_t ns = 0;
  Role role = Role::resampled;
  bool steady = true;  // known precisely enough to find late samples
};

/// Chooses the step of a stream: the stated step or the median of its steps. The stated step is
/// used in two cases: it differs greatly from the median (stamps in bursts), or a slow loop read
/// the samples and the stated step is within 5 % of the mean usual step.
///
/// The median is steady in three cases. The mean of the usual steps is within 8 % of it. Or it is
/// within 12 %, and the mean of all steps within 3 % (a stall without losses does not change that
/// mean). Or the stated step is within 5 % of it. If stamps are coarsely rounded or the rate has
/// changed, the median is not steady.
TakenStep taken_step(const RecordedStream& stream, const StreamOptions& options, Role role);

}  // namespace kinalign
