// SPDX-License-Identifier: Apache-2.0
// The step at which a device took its samples, by which delayed samples are recognised.
#pragma once

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <cstdint>

namespace kinalign {

/// The role of a stream: its stamps are the grid, or it is resampled onto the grid.
enum class Role { reference, resampled };

/// A device's step. With ns = 0 the step is unknown and no delay is found. Delayed samples of the
/// reference are counted; those of other streams are dropped.
struct TakenStep {
  std::int64_t ns = 0;
  Role role = Role::resampled;
  bool steady = true;  // known well enough to recognise late samples
};

/// Chooses the step of a stream. The stated step is used if it differs greatly from the median
/// (stamps in bursts), or if a loop slower than the device read the samples and the stated step is
/// within 5 % of the mean usual step. Otherwise the median is used.
///
/// The median is steady if the mean of the usual steps is within 8 % of it, or if the mean of all
/// steps is within 3 % of it (a stall without losses does not change that mean), or if the stated
/// step is within 5 % of it. It is not steady if stamps are coarsely rounded or the rate has
/// changed.
TakenStep taken_step(const RecordedStream& stream, const StreamOptions& options, Role role);

}  // namespace kinalign
