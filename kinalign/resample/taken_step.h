// SPDX-License-Identifier: Apache-2.0
// The step in which a device took its samples, by which one that was held back on its way is told.
#pragma once

#include "kinalign/take/manifest.h"
#include "kinalign/take/recording.h"

#include <cstdint>

namespace kinalign {

/// What becomes of a stream's samples: their stamps are the grid, or they are resampled onto it.
enum class Role { reference, resampled };

/// 0: no step is known, nothing is told. Samples held back are counted of the reference, and left
/// out of other streams.
struct TakenStep {
  std::int64_t ns = 0;
  Role role = Role::resampled;
  bool steady = true;  // known well enough to tell late samples by
};

/// The stated step where it says quite another than the median (stamps in bursts), or where a loop
/// slower than the device read them and it is within 5 % of the mean of the usual steps; else the
/// median. That is steady where those differ from it by less than 8 % in the mean, where the mean
/// of all does by less than 3 %, which a stall without losses leaves as it was, or the stated one
/// by less than 5 %: not where stamps are rounded coarsely or the rate has changed.
TakenStep taken_step(const RecordedStream& stream, const StreamOptions& options, Role role);

}  // namespace kinalign
